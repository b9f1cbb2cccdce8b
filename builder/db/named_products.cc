// SPDX-License-Identifier: Apache-2.0
#include "builder/db/named_products.h"

#include "builder/db/hash_column.h"

#include <filesystem>
#include <system_error>

namespace ds {

std::vector<DatasetRow> all_datasets(Database& database) {
  std::vector<std::string> ids;
  {
    Statement row = database.connection().prepare("SELECT id FROM dataset ORDER BY name, id");
    while (row.step())
      ids.push_back(row.text(0));
  }
  std::vector<DatasetRow> rows;
  for (const std::string& id : ids)
    if (auto row = database.find_dataset(id)) rows.push_back(std::move(*row));
  return rows;
}

void visit_all_images(
    Database& database,
    const std::function<void(const std::string& dataset, const PartHashes&)>& visit) {
  Statement row = database.connection().prepare(
      "SELECT dataset, model, material, environment, camera, engine, files FROM image");
  while (row.step()) {
    PartHashes parts;
    for (std::size_t i = 0; i < parts.size(); ++i)
      parts[i] = hash_column(row, static_cast<int>(i) + 1);
    visit(row.text(0), parts);
  }
}

void visit_all_placed(
    Database& database,
    const std::function<void(const std::string& dataset, const PlacedView&)>& visit) {
  Statement row = database.connection().prepare(
      "SELECT dataset, path, image, kind, product, object FROM placed");
  while (row.step())
    visit(row.text(0),
          {row.view(1), row.view(2), row.view(3), hash_column(row, 4), hash_column(row, 5), {}});
}

void visit_products(
    Database& database,
    const std::function<void(Hash128 key, std::string_view kind, Hash128 object)>& visit) {
  Statement row = database.connection().prepare("SELECT key, kind, object FROM product");
  while (row.step())
    visit(hash_column(row, 0), row.view(1), hash_column(row, 2));
}

void visit_running_builds(
    Database& database, const std::function<void(const std::string& dataset, const BuildRow& build,
                                                 std::int64_t unix_seconds)>& visit) {
  Statement row = database.connection().prepare(
      "SELECT dataset.name, build.host, build.process, build.outcome, "
      "CAST(strftime('%s', build.started_at) AS INTEGER) "
      "FROM build JOIN dataset ON dataset.id = build.dataset WHERE build.outcome = 'running'");
  while (row.step()) {
    BuildRow build;
    build.host = row.text(1);
    build.process = row.integer(2);
    build.outcome = row.text(3);
    visit(row.text(0), build, row.integer(4));
  }
}

void remove_product(Database& database, Hash128 key) {
  database.connection().prepare("DELETE FROM product WHERE key = ?1").bind(1, key.hex()).run();
}

void remove_dataset(Database& database, const std::string& id) {
  for (const char* sql :
       {"DELETE FROM image WHERE dataset = ?1", "DELETE FROM placed WHERE dataset = ?1",
        "DELETE FROM build WHERE dataset = ?1", "DELETE FROM dataset WHERE id = ?1"})
    database.connection().prepare(sql).bind(1, id).run();
}

DatabaseSize size_of(Database& database) {
  const auto number = [&](const char* pragma) {
    Statement row = database.connection().prepare(pragma);
    row.step();
    return row.count(0);
  };
  const std::uint64_t page = number("PRAGMA page_size");
  DatabaseSize size{page * number("PRAGMA page_count"), page * number("PRAGMA freelist_count")};
  Statement files =
      database.connection().prepare("SELECT file FROM pragma_database_list WHERE name = 'main'");
  files.step();
  std::error_code no_log;
  const auto log = std::filesystem::file_size(files.text(0) + "-wal", no_log);
  if (!no_log) size.bytes += log;
  return size;
}

void shrink(Database& database) {
  database.connection().execute("VACUUM");
  database.connection().execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

}  // namespace ds

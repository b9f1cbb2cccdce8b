// SPDX-License-Identifier: Apache-2.0
#include "builder/db/named_products.h"

#include "builder/db/hash_column.h"

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

void remove_product(Database& database, Hash128 key) {
  database.connection().prepare("DELETE FROM product WHERE key = ?1").bind(1, key.hex()).run();
}

void remove_dataset(Database& database, const std::string& id) {
  for (const char* sql :
       {"DELETE FROM image WHERE dataset = ?1", "DELETE FROM placed WHERE dataset = ?1",
        "DELETE FROM build WHERE dataset = ?1", "DELETE FROM dataset WHERE id = ?1"})
    database.connection().prepare(sql).bind(1, id).run();
}

}  // namespace ds

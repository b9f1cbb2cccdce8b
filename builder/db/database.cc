// SPDX-License-Identifier: Apache-2.0
#include "builder/db/database.h"

#include "builder/db/hash_column.h"
#include "builder/db/schema.h"
#include "manifests/film_facts.h"
#include "manifests/json_text.h"

#include <nlohmann/json.hpp>

namespace ds {
namespace {

constexpr const char* k_pixel_counts = "pixel_counts";

/// What is known of a product beside its bytes, as one JSON object: FilmFacts and PixelCounts.
std::string facts_text(const Product& product) {
  nlohmann::json object = to_json_value(product.facts);
  if (product.pixel_counts != PixelCounts{})
    object[k_pixel_counts] = to_json_value(product.pixel_counts);
  return canonical_json(object);
}

void read_facts(const std::string& text, Product& product) {
  if (text.empty()) return;
  try {
    const nlohmann::json object = nlohmann::json::parse(text);
    product.facts = film_facts_from(object);
    if (const auto counts = object.find(k_pixel_counts); counts != object.end())
      product.pixel_counts = pixel_counts_from(*counts);
  } catch (const nlohmann::json::exception& error) {
    throw DamagedDatabase(fmt::format("the database is damaged: facts: {}", json_fault(error)));
  } catch (const Error& error) {
    throw DamagedDatabase(fmt::format("the database is damaged: {}", error.what()));
  }
}

template <typename T>
T json_column(const Statement& row, int column) {
  try {
    return nlohmann::json::parse(row.text(column)).get<T>();
  } catch (const nlohmann::json::exception& error) {
    throw DamagedDatabase(fmt::format("the database is damaged: {}", json_fault(error)));
  }
}

std::vector<std::string> parse_overrides(const std::string& text) {
  try {
    return nlohmann::json::parse(text).get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception& error) {
    throw DamagedDatabase(fmt::format("the database is damaged: overrides: {}", json_fault(error)));
  }
}

}  // namespace

Database::Database(const std::filesystem::path& file)
    : check_(file), connection_(std::make_unique<Connection>(file)) {
  prepare_schema(*connection_, file.string());
  if (check_.needed()) connection_->check();
}

Database::~Database() {
  connection_.reset();
  check_.passed();
}

std::int64_t Database::data_version() {
  Statement row = connection_->prepare("PRAGMA data_version");
  row.step();
  return row.integer(0);
}

void Database::put_text(Hash128 hash, std::string_view text) {
  connection_->prepare("INSERT OR IGNORE INTO text VALUES (?1, ?2)")
      .bind(1, hash.hex())
      .bind(2, text)
      .run();
}

std::optional<std::string> Database::find_text(Hash128 hash) {
  Statement row = connection_->prepare("SELECT body FROM text WHERE hash = ?1");
  if (!row.bind(1, hash.hex()).step()) return std::nullopt;
  return row.text(0);
}

std::optional<Hash128> Database::find_content(const std::filesystem::path& file,
                                              const FileStamp& stamp) {
  Statement row = connection_->prepare(
      "SELECT content FROM input_file WHERE path = ?1 AND size_bytes = ?2 AND mtime_ns = ?3 AND "
      "inode = ?4 AND ctime_ns = ?5");
  row.bind(1, file.string())
      .bind_count(2, stamp.size_bytes)
      .bind(3, stamp.mtime_ns)
      .bind_count(4, stamp.inode)
      .bind(5, stamp.ctime_ns);
  if (!row.step()) return std::nullopt;
  return hash_column(row, 0);
}

void Database::put_content(const std::filesystem::path& file, const FileStamp& stamp,
                           Hash128 content) {
  connection_->prepare("INSERT OR REPLACE INTO input_file VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
      .bind(1, file.string())
      .bind_count(2, stamp.size_bytes)
      .bind(3, stamp.mtime_ns)
      .bind_count(4, stamp.inode)
      .bind(5, content.hex())
      .bind(6, stamp.ctime_ns)
      .run();
}

std::optional<KnownModel> Database::find_model(Hash128 content, int reader) {
  Statement row = connection_->prepare(
      "SELECT geometry, uvs, colors, damage, extent, normals, shape FROM geometry "
      "WHERE content = ?1 AND reader = ?2");
  if (!row.bind(1, content.hex()).bind(2, std::int64_t{reader}).step()) return std::nullopt;
  const auto e = json_column<std::array<double, 9>>(row, 4);
  return KnownModel{
      {hash_column(row, 0), hash_column(row, 1), hash_column(row, 2), hash_column(row, 5)},
      json_column<MendedDamage>(row, 3),
      {{{e[0], e[1], e[2]}, {e[3], e[4], e[5]}}, {e[6], e[7], e[8]}},
      std::string(row.text(6))};
}

void Database::put_model(Hash128 content, int reader, const KnownModel& model) {
  const auto& [box, centroid] = model.extent;
  const auto& [least, most] = box;
  connection_
      ->prepare("INSERT OR REPLACE INTO geometry VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)")
      .bind(1, content.hex())
      .bind(2, std::int64_t{reader})
      .bind(3, model.hashes.shape.hex())
      .bind(4, nlohmann::json(model.damage).dump())
      .bind(5, model.hashes.uvs.hex())
      .bind(6, model.hashes.colors.hex())
      .bind(7, model.hashes.normals.hex())
      .bind(8, nlohmann::json({least.x, least.y, least.z, most.x, most.y, most.z, centroid.x,
                               centroid.y, centroid.z})
                   .dump())
      .bind(9, model.shape)
      .run();
}

std::optional<std::array<float, 6>> Database::find_image_bounds(Hash128 image, int reader) {
  Statement row =
      connection_->prepare("SELECT bounds FROM image_bounds WHERE image = ?1 AND reader = ?2");
  if (!row.bind(1, image.hex()).bind(2, std::int64_t{reader}).step()) return std::nullopt;
  return json_column<std::array<float, 6>>(row, 0);
}

void Database::put_image_bounds(Hash128 image, int reader, const std::array<float, 6>& bounds) {
  connection_->prepare("INSERT OR REPLACE INTO image_bounds VALUES (?1, ?2, ?3)")
      .bind(1, image.hex())
      .bind(2, std::int64_t{reader})
      .bind(3, nlohmann::json(bounds).dump())
      .run();
}

std::optional<std::array<double, 4>> Database::find_sphere(Hash128 model_part, int reader) {
  Statement row =
      connection_->prepare("SELECT x, y, z, radius FROM sphere WHERE model = ?1 AND reader = ?2");
  if (!row.bind(1, model_part.hex()).bind(2, std::int64_t{reader}).step()) return std::nullopt;
  return std::array{row.real(0), row.real(1), row.real(2), row.real(3)};
}

void Database::put_sphere(Hash128 model_part, int reader, const std::array<double, 4>& sphere) {
  connection_->prepare("INSERT OR REPLACE INTO sphere VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
      .bind(1, model_part.hex())
      .bind(2, std::int64_t{reader})
      .bind(3, sphere[0])
      .bind(4, sphere[1])
      .bind(5, sphere[2])
      .bind(6, sphere[3])
      .run();
}

std::optional<std::string> Database::find_known(const std::string& program,
                                                const std::string& question) {
  Statement row =
      connection_->prepare("SELECT answer FROM known WHERE program = ?1 AND question = ?2");
  if (!row.bind(1, program).bind(2, question).step()) return std::nullopt;
  return row.text(0);
}

void Database::put_known(const std::string& program, const std::string& question,
                         const std::string& answer) {
  connection_->prepare("DELETE FROM known WHERE program != ?1").bind(1, program).run();
  connection_->prepare("INSERT OR REPLACE INTO known VALUES (?1, ?2, ?3)")
      .bind(1, program)
      .bind(2, question)
      .bind(3, answer)
      .run();
}

bool Database::has_products() {
  return connection_->prepare("SELECT 1 FROM product LIMIT 1").step();
}

std::vector<Hash128> Database::pictures_with_rejected() {
  std::vector<Hash128> keys;
  // As the index product_rejected says it.
  Statement row =
      connection_->prepare("SELECT key FROM product WHERE rejected_samples > 0 AND kind = 'image'");
  while (row.step())
    keys.push_back(hash_column(row, 0));
  return keys;
}

std::vector<std::pair<Hash128, double>> Database::capped_pictures() {
  std::vector<std::pair<Hash128, double>> pictures;
  // As the index product_capped says it.
  Statement row = connection_->prepare(
      "SELECT key, json_valid(facts), CASE WHEN json_valid(facts) THEN "
      "json_extract(facts, '$.developed_high') END FROM product WHERE "
      "instr(facts, '\"capped\":true') > 0 AND kind = 'image'");
  while (row.step()) {
    if (row.integer(1) == 0) throw DamagedDatabase("the database is damaged: facts: no JSON");
    pictures.emplace_back(hash_column(row, 0), row.optional_real(2).value_or(0));
  }
  return pictures;
}

std::optional<Product> Database::find_product(Hash128 key) {
  Statement row = connection_->prepare(
      "SELECT kind, object, size_bytes, sha256, pixels, tone_map_scale, rejected_samples, "
      "relative_error, facts FROM product WHERE key = ?1");
  if (!row.bind(1, key.hex()).step()) return std::nullopt;
  Product product{key,          row.text(0),  hash_column(row, 1),
                  row.count(2), row.text(3),  hash_column(row, 4),
                  row.real(5),  row.count(6), row.optional_real(7)};
  read_facts(row.text(8), product);
  return product;
}

void Database::put_product(const Product& product, const TraceRun& run) {
  connection_
      ->prepare(
          "INSERT OR REPLACE INTO product VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, "
          "?12)")
      .bind(1, product.key.hex())
      .bind(2, product.kind)
      .bind(3, product.object.hex())
      .bind_count(4, product.size_bytes)
      .bind(5, product.sha256)
      .bind(6, product.pixels.hex())
      .bind(7, product.tone_map_scale)
      .bind_count(8, product.rejected_samples)
      .bind_optional(9, product.relative_error)
      .bind(10, run.seconds)
      .bind(11, run.device)
      .bind(12, facts_text(product))
      .run();
}

void Database::add_pixel_counts(Hash128 key, const PixelCounts& counts) {
  std::optional<Product> product = find_product(key);
  if (!product) return;
  add_counts(product->pixel_counts, counts);
  connection_->prepare("UPDATE product SET facts = ?2 WHERE key = ?1")
      .bind(1, key.hex())
      .bind(2, facts_text(*product))
      .run();
}

std::optional<DatasetRow> Database::find_dataset(const std::string& id) {
  Statement row = connection_->prepare(
      "SELECT name, recipe, working_folder, overrides, manifest FROM dataset WHERE id = ?1");
  if (!row.bind(1, id).step()) return std::nullopt;
  return DatasetRow{
      id, row.text(0), row.text(1), row.text(2), parse_overrides(row.text(3)), hash_column(row, 4)};
}

void Database::put_dataset(const DatasetRow& row) {
  // A folder or file name may hold any bytes; what is not UTF-8 is refused by the JSON writer only
  // for overrides.
  connection_->prepare("INSERT OR REPLACE INTO dataset VALUES (?1, ?2, ?3, ?4, ?5, ?6)")
      .bind(1, row.id)
      .bind(2, row.name)
      .bind(3, row.recipe.string())
      .bind(4, row.working_folder.string())
      .bind(5, nlohmann::json(row.overrides).dump())
      .bind(6, row.manifest.hex())
      .run();
}

void Database::set_manifest(const std::string& dataset, Hash128 manifest) {
  connection_->prepare("UPDATE dataset SET manifest = ?2 WHERE id = ?1")
      .bind(1, dataset)
      .bind(2, manifest.hex())
      .run();
}

std::map<std::string, PartHashes> Database::images(const std::string& dataset) {
  std::map<std::string, PartHashes> images;
  visit_images(dataset, [&](std::string_view id, const PartHashes& parts) {
    images.emplace_hint(images.end(), id, parts);
  });
  return images;
}

void Database::visit_images(const std::string& dataset,
                            const std::function<void(std::string_view, const PartHashes&)>& visit) {
  Statement row = connection_->prepare(
      "SELECT id, model, material, environment, camera, engine, files FROM image WHERE dataset = "
      "?1");
  row.bind(1, dataset);
  PartHashes parts;
  while (row.step()) {
    for (std::size_t i = 0; i < k_part_count; ++i)
      parts[i] = hash_column(row, static_cast<int>(i) + 1);
    visit(row.view(0), parts);
  }
}

void Database::put_image(const std::string& dataset, const std::string& image,
                         const PartHashes& parts) {
  Statement statement =
      connection_->prepare("INSERT OR REPLACE INTO image VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
  statement.bind(1, dataset).bind(2, image);
  for (std::size_t i = 0; i < k_part_count; ++i)
    statement.bind(static_cast<int>(i) + 3, parts[i].hex());
  statement.run();
}

void Database::remove_image(const std::string& dataset, const std::string& image) {
  connection_->prepare("DELETE FROM image WHERE dataset = ?1 AND id = ?2")
      .bind(1, dataset)
      .bind(2, image)
      .run();
}

std::map<std::string, PlacedFile> Database::placed_files(const std::string& dataset) {
  std::map<std::string, PlacedFile> files;
  visit_placed(dataset, [&](const PlacedView& row) {
    files.emplace_hint(files.end(), row.path,
                       PlacedFile{std::string(row.path), std::string(row.image),
                                  std::string(row.kind), row.product, row.object, row.stamp});
  });
  return files;
}

void Database::visit_placed(const std::string& dataset,
                            const std::function<void(const PlacedView&)>& visit) {
  Statement row = connection_->prepare(
      "SELECT path, image, kind, product, object, size_bytes, mtime_ns, inode, ctime_ns FROM "
      "placed WHERE dataset = ?1");
  row.bind(1, dataset);
  while (row.step()) {
    PlacedView file{row.view(0),         row.view(1),         row.view(2),
                    hash_column(row, 3), hash_column(row, 4), std::nullopt};
    if (row.integer(7) != 0)
      file.stamp = FileStamp{row.count(5), row.integer(6), row.integer(8), row.count(7)};
    visit(file);
  }
}

void Database::put_placed(const std::string& dataset, const PlacedFile& file) {
  const FileStamp stamp = file.stamp.value_or(FileStamp{});
  connection_
      ->prepare("INSERT OR REPLACE INTO placed VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)")
      .bind(1, dataset)
      .bind(2, file.path)
      .bind(3, file.image)
      .bind(4, file.kind)
      .bind(5, file.product.hex())
      .bind(6, file.object.hex())
      .bind_count(7, stamp.size_bytes)
      .bind(8, stamp.mtime_ns)
      .bind_count(9, stamp.inode)
      .bind(10, stamp.ctime_ns)
      .run();
}

void Database::remove_placed(const std::string& dataset, const std::string& path) {
  connection_->prepare("DELETE FROM placed WHERE dataset = ?1 AND path = ?2")
      .bind(1, dataset)
      .bind(2, path)
      .run();
}

std::int64_t Database::begin_build(const std::string& dataset, const std::string& host,
                                   std::int64_t process) {
  Statement row = connection_->prepare(
      "INSERT INTO build (dataset, started_at, host, process, device, outcome, images, built, "
      "reused, failed, "
      "traced_samples, seconds) VALUES (?1, datetime('now'), ?2, ?3, '', 'running', 0, 0, 0, 0, 0, "
      "0) "
      "RETURNING number");
  row.bind(1, dataset).bind(2, host).bind(3, process).step();
  const std::int64_t number = row.integer(0);
  row.step();  // to its end: the row is only written then
  return number;
}

void Database::update_build(const BuildRow& row) {
  connection_
      ->prepare(
          "UPDATE build SET device = ?2, outcome = ?3, images = ?4, built = ?5, reused = ?6, "
          "failed = ?7, "
          "traced_samples = ?8, seconds = ?9 WHERE number = ?1")
      .bind(1, row.number)
      .bind(2, row.device)
      .bind(3, row.outcome)
      .bind_count(4, row.images)
      .bind_count(5, row.built)
      .bind_count(6, row.reused)
      .bind_count(7, row.failed)
      .bind_count(8, row.traced_samples)
      .bind(9, row.seconds)
      .run();
}

std::vector<BuildRow> Database::builds(const std::string& dataset) {
  std::vector<BuildRow> builds;
  Statement row = connection_->prepare(
      "SELECT number, started_at, host, process, device, outcome, images, built, reused, failed, "
      "traced_samples, seconds "
      "FROM build WHERE dataset = ?1 ORDER BY number DESC");
  row.bind(1, dataset);
  while (row.step())
    builds.push_back({row.integer(0), row.text(1), row.text(2), row.integer(3), row.text(4),
                      row.text(5), row.count(6), row.count(7), row.count(8), row.count(9),
                      row.count(10), row.real(11)});
  return builds;
}

}  // namespace ds

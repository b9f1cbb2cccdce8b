// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/file_check.h"
#include "builder/db/file_stamp.h"
#include "builder/db/sqlite.h"
#include "manifests/pixel_counts.h"
#include "tracer/base/hash.h"
#include "tracer/render/render.h"
#include "tracer/scene/mesh.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Something made and kept: a film, or one file of an image. The key is a hash of all it depends
/// on.
struct Product {
  Hash128 key;
  std::string kind;  ///< "film", "image", "mask", "depth"
  Hash128 object;    ///< of its bytes: its name in the store
  std::uint64_t size_bytes = 0;
  std::string sha256;                  ///< of its bytes
  Hash128 pixels;                      ///< of its decoded pixels
  double tone_map_scale = 1;           ///< images: the factor the tone map used
  std::uint64_t rejected_samples = 0;  ///< films and images
  /// Films and images: Film::relative_error, where it is known.
  std::optional<double> relative_error{};
  FilmFacts facts{};           ///< films and images: of the film
  PixelCounts pixel_counts{};  ///< images and masks; absent where an older dsbuild made them
};

/// How and when a film was made. Never in a manifest: another machine has other values.
struct TraceRun {
  double seconds = 0;
  std::string device;
};

/// The parts of an image's render key, then the text of what is done to its film.
inline constexpr std::size_t k_part_count = 6;
inline constexpr std::array<const char*, k_part_count> k_part_names{
    "model", "material", "environment", "camera", "engine", "files"};
using PartHashes = std::array<Hash128, k_part_count>;

/// A file that dsbuild put into a dataset's folder.
struct PlacedFile {
  std::string path;   ///< relative to the dataset's folder
  std::string image;  ///< id
  std::string kind;
  Hash128 product;
  Hash128 object;
  std::optional<FileStamp> stamp;  ///< absent: not seen whole since it was recorded
};

/// The same, read from a row that is not copied.
struct PlacedView {
  std::string_view path, image, kind;
  Hash128 product, object;
  std::optional<FileStamp> stamp;
};

/// What is known of a model file's content.
struct KnownModel {
  MeshHashes hashes;
  MendedDamage damage;
  MeshExtent extent;
  std::string shape{};  ///< shape_of

  bool operator==(const KnownModel&) const = default;
};

struct DatasetRow {
  std::string id;  ///< 32 hexadecimal digits, fixed when the dataset is first built
  std::string name;
  std::filesystem::path recipe;          ///< absolute
  std::filesystem::path working_folder;  ///< what relative paths in `overrides` start from
  std::vector<std::string> overrides;
  Hash128 manifest;  ///< of what the manifest was written from, zero before the first

  bool operator==(const DatasetRow&) const = default;
};

struct BuildRow {
  std::int64_t number = 0;
  std::string started_at;  ///< UTC, "2024-02-29 12:00:00"
  std::string host;
  std::int64_t process = 0;  ///< number on that host
  std::string device;
  std::string
      outcome;  ///< "running" (or killed), "done", "failed", "stopped", "killed", "disk failed"
  std::uint64_t images = 0, built = 0, reused = 0, failed = 0, traced_samples = 0;
  double seconds = 0;
};

/// What dsbuild remembers between runs, for every dataset of one store. Every call is one
/// statement; callers group calls in a `Transaction` of `connection()`. Throws what `Statement`
/// throws. Not safe from two threads at once.
class Database {
 public:
  /// Opens or makes the file, and checks it whole unless it is as the last process that had it open
  /// left it (file_check.h). Throws DamagedDatabase, or Error(io) where the file was made by a newer
  /// dsbuild. An empty path is a database in memory.
  explicit Database(const std::filesystem::path& file);
  ~Database();
  Connection& connection() { return *connection_; }
  /// Another number once another connection has written.
  std::int64_t data_version();

  /// Canonical texts by their hash.
  void put_text(Hash128 hash, std::string_view text);
  std::optional<std::string> find_text(Hash128 hash);

  /// Content hashes of input files by stamp.
  std::optional<Hash128> find_content(const std::filesystem::path& file, const FileStamp& stamp);
  void put_content(const std::filesystem::path& file, const FileStamp& stamp, Hash128 content);
  /// Model files by content. `reader` is the version of what read them.
  std::optional<KnownModel> find_model(Hash128 content, int reader);
  void put_model(Hash128 content, int reader, const KnownModel& model);

  /// x, y, z and radius of the ball around a normalised model, by the hash of its part of the key.
  std::optional<std::array<double, 4>> find_sphere(Hash128 model_part, int reader);
  void put_sphere(Hash128 model_part, int reader, const std::array<double, 4>& sphere);

  /// The least and greatest red, green and blue of an image as a texture uses it, by the hash of its
  /// content and use.
  std::optional<std::array<float, 6>> find_image_bounds(Hash128 image, int reader);
  void put_image_bounds(Hash128 image, int reader, const std::array<float, 6>& bounds);

  /// What this program found out of a question before: of what may be found out again.
  std::optional<std::string> find_known(const std::string& program, const std::string& question);
  /// Forgets what other programs found.
  void put_known(const std::string& program, const std::string& question,
                 const std::string& answer);

  bool has_products();
  /// Keys of the pictures of which some samples had to be left out: few.
  std::vector<Hash128> pictures_with_rejected();
  /// The keys of pictures that engine.max_spp ended before engine.error was reached, and the upper
  /// end of each one's error.
  std::vector<std::pair<Hash128, double>> capped_pictures();
  std::optional<Product> find_product(Hash128 key);
  void put_product(const Product& product, const TraceRun& run);
  /// Adds counts to a product that was made without; nothing where there is no such product.
  void add_pixel_counts(Hash128 key, const PixelCounts& counts);

  std::optional<DatasetRow> find_dataset(const std::string& id);
  void put_dataset(const DatasetRow& row);
  void set_manifest(const std::string& dataset, Hash128 manifest);

  std::map<std::string, PartHashes> images(const std::string& dataset);
  /// The same, one after the other; the id holds during the call.
  void visit_images(const std::string& dataset,
                    const std::function<void(std::string_view id, const PartHashes&)>& visit);
  void put_image(const std::string& dataset, const std::string& image, const PartHashes& parts);
  void remove_image(const std::string& dataset, const std::string& image);

  /// By path.
  std::map<std::string, PlacedFile> placed_files(const std::string& dataset);
  /// The same, one after the other; the texts hold during the call.
  void visit_placed(const std::string& dataset,
                    const std::function<void(const PlacedView&)>& visit);
  void put_placed(const std::string& dataset, const PlacedFile& file);
  void remove_placed(const std::string& dataset, const std::string& path);

  std::int64_t begin_build(const std::string& dataset, const std::string& host,
                           std::int64_t process);
  void update_build(const BuildRow& row);
  /// The newest first.
  std::vector<BuildRow> builds(const std::string& dataset);

 private:
  FileCheck check_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace ds

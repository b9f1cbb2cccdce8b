// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest.h"

#include "manifests/film_facts.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace ds {
namespace {

using nlohmann::json;

/// Row-major numbers as nested rows, which numpy.array reads as a matrix.
template <std::size_t N>
json matrix(const std::array<double, N>& values, std::size_t columns) {
  json rows = json::array();
  for (std::size_t i = 0; i < N; i += columns) {
    rows.push_back(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(i),
                                       values.begin() + static_cast<std::ptrdiff_t>(i + columns)));
  }
  return rows;
}

json to_json_value(const FileRecord& file) {
  return {{"path", file.path},
          {"kind", file.kind},
          {"size_bytes", file.hashes.size_bytes},
          {"xxh128", file.hashes.xxh128.hex()},
          {"sha256", file.hashes.sha256},
          {"pixels_xxh128", file.pixels.hex()}};
}

json to_json_value(const ImageRecord& image) {
  json files = json::array();
  for (const FileRecord& file : image.files)
    files.push_back(to_json_value(file));
  const auto& parts = image.parts;
  return {{"id", image.id},
          {"model", image.model},
          {"class_path", image.class_path},
          {"split", image.split},
          {"material", image.material},
          {"environment", image.environment},
          {"view", image.view},
          {"files", std::move(files)},
          {"seed", image.seed},
          {"spp", image.spp},
          {"width", image.width},
          {"height", image.height},
          {"math", image.math},
          {"intrinsics", matrix(image.intrinsics, 3)},
          {"camera_to_world", matrix(image.camera_to_world, 4)},
          {"camera_convention", "opencv"},
          {"lens_radius_m", image.lens_radius_m},
          {"focus_distance_m", image.focus_distance_m},
          {"tone_map_scale", image.tone_map_scale},
          {"rejected_samples", image.rejected_samples},
          {"relative_error", image.relative_error ? json(*image.relative_error) : json()},
          {"film", to_json_value(image.film)},
          {"pixel_counts", to_json_value(image.pixel_counts)},
          {"render_key", image.render_key.hex()},
          {"files_key", image.files_key.hex()},
          {"parts",
           {{"model", parts[0].hex()},
            {"material", parts[1].hex()},
            {"environment", parts[2].hex()},
            {"camera", parts[3].hex()},
            {"engine", parts[4].hex()}}}};
}

json counts_object(const std::vector<std::pair<std::string, std::uint64_t>>& counts) {
  json object = json::object();
  for (const auto& [name, count] : counts)
    object[name] = count;
  return object;
}

json to_json_value(const LicenceRecord& licence) {
  return {{"spdx", licence.spdx.empty() ? json() : json(licence.spdx)},
          {"text", licence.text},
          {"assets", licence.assets}};
}

json to_json_value(const DatasetRecord& dataset) {
  json licences = json::array();
  for (const LicenceRecord& licence : dataset.licences)
    licences.push_back(to_json_value(licence));
  json object{
      {"format", k_manifest_format},
      {"name", dataset.name},
      {"licence", dataset.licence},
      {"recipe", dataset.recipe_text},
      {"dsbuild_version", dataset.dsbuild_version},
      {"seed", dataset.seed},
      {"class_paths", dataset.class_paths},
      {"counts", counts_object(dataset.counts)},
      {"licences", std::move(licences)},
      {"conventions",
       {{"world", "right-handed, z up, metres"},
        {"camera_to_world",
         "4x4, row-major, column vectors; opencv camera: x right, y down, z forward"},
        {"intrinsics",
         "3x3, row-major, pixels; origin at the top left corner, pixel centres at .5"},
        {"depth", "planar z along the camera's z axis in metres, 0 where nothing is hit"},
        {"mask",
         "255 where the ray through the pixel's centre and the pinhole meets the model first, "
         "else 0"}}}};
  for (const Concern& concern : dataset.concerns)
    object["concerns"][concern.name] = {
        {"count", concern.count}, {"of", concern.of}, {"examples", concern.examples}};
  for (const auto& [model, damage] : dataset.mended_models)
    object["mended_models"][model] = counts_object(damage);
  return object;
}

/// One line a path in checksums.xxh128, and `xxhsum -c` reads no escapes.
void check_path(const std::string& path) {
  const std::filesystem::path parts(path);
  const bool leaves =
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part == ".."; });
  const bool odd = std::any_of(path.begin(), path.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\';
  });
  if (path.empty() || parts.is_absolute() || leaves || odd) {
    fail(ErrorKind::asset,
         "a dataset's path must be relative, stay in its folder and hold no control character or "
         "backslash, got {:?}",
         path);
  }
}

/// path -> hash of every file of every image.
std::map<std::string, Hash128> checksums_of(const std::vector<ImageRecord>& images) {
  std::map<std::string, Hash128> checksums;
  for (const ImageRecord& image : images) {
    for (const FileRecord& file : image.files) {
      check_path(file.path);
      if (!checksums.emplace(file.path, file.hashes.xxh128).second) {
        fail(ErrorKind::asset, "image {}: the file {} belongs to another image too", image.id,
             file.path);
      }
    }
  }
  return checksums;
}

std::string images_text(const std::vector<ImageRecord>& images) {
  std::map<std::string_view, const ImageRecord*> by_id;
  for (const ImageRecord& image : images) {
    if (!by_id.emplace(image.id, &image).second)
      fail(ErrorKind::asset, "image {} stands twice", image.id);
  }
  std::string text;
  for (const auto& [id, image] : by_id)
    text += to_json_line(*image) + '\n';
  return text;
}

}  // namespace

std::string to_json_line(const ImageRecord& image) {
  return canonical_json(to_json_value(image));
}

std::string to_json(const DatasetRecord& dataset) {
  return canonical_json(to_json_value(dataset), 2);
}

void write_manifest(const std::filesystem::path& folder, const DatasetRecord& dataset,
                    const std::vector<ImageRecord>& images) {
  auto checksums = checksums_of(images);
  const std::string lines = images_text(images);
  const std::string description = to_json(dataset);
  const auto write = [&](const std::string& path, const std::string& text) {
    write_file_atomic(folder / path, text);
    checksums[path] = hash_text(text);
  };
  write("manifest/images.jsonl", lines);
  write("manifest/dataset.json", description);
  std::string text;
  for (const auto& [path, hash] : checksums)
    text += hash.hex() + "  " + path + '\n';
  write_file_atomic(folder / "manifest/checksums.xxh128", text);
}

}  // namespace ds

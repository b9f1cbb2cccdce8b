// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest.h"

#include "manifests/film_facts.h"
#include "manifests/json_text.h"

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

/// null where no pixel of the picture could show the model.
json visible_fraction(const PixelCounts& counts) {
  if (*counts.amodal == 0) return {};
  return static_cast<double>(*counts.model) / static_cast<double>(*counts.amodal);
}

json to_json_value(const ImageRecord& image) {
  json files = json::array();
  for (const FileRecord& file : image.files)
    files.push_back(to_json_value(file));
  const auto& parts = image.parts;
  json line{{"id", image.id},
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
  if (image.pixel_counts.model && image.pixel_counts.amodal)
    line["visible_fraction"] = visible_fraction(image.pixel_counts);
  return line;
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
  json object{{"format", k_manifest_format},
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
                 "3x3, row-major, pixels; origin at the top left corner, pixel centres at .5"}}}};
  for (const auto& [name, plane] : dataset.planes)
    object["planes"][name] = {{"encoding", plane.encoding}, {"convention", plane.convention}};
  for (const Concern& concern : dataset.concerns)
    object["concerns"][concern.name] = {
        {"count", concern.count}, {"of", concern.of}, {"examples", concern.examples}};
  for (const auto& [model, damage] : dataset.mended_models)
    object["mended_models"][model] = counts_object(damage);
  return object;
}

}  // namespace

std::string to_json_line(const ImageRecord& image) {
  return canonical_json(to_json_value(image));
}

std::string to_json(const DatasetRecord& dataset) {
  return canonical_json(to_json_value(dataset), 2);
}

}  // namespace ds

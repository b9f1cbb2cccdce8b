// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/hub_features.h"

#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

namespace ds {
namespace {

constexpr std::pair<const char*, ParquetType> k_fields[] = {
    {"label", ParquetType::int64},
    {"class_path", ParquetType::text},
    {"model", ParquetType::text},
    {"material", ParquetType::text},
    {"environment", ParquetType::text},
    {"view", ParquetType::text},
    {"seed", ParquetType::int64},
    {"spp", ParquetType::int64},
    {"width", ParquetType::int64},
    {"height", ParquetType::int64},
    {"camera_model", ParquetType::text},
    {"intrinsics", ParquetType::float64_matrix},
    {"metres_per_pixel", ParquetType::float64},
    {"camera_to_world", ParquetType::float64_matrix},
    {"relative_error", ParquetType::float64},
    {"lens_radius_m", ParquetType::float64},
    {"focus_distance_m", ParquetType::float64},
    {"tone_map_scale", ParquetType::float64},
    {"model_to_world", ParquetType::float64_matrix},
    {"box_m", ParquetType::float64_matrix},
};

constexpr std::string_view k_draws = "draws.";

/// Those that every image has one of, if any.
std::vector<ParquetFile::Column> draw_columns(const DatasetRecord& dataset) {
  std::vector<ParquetFile::Column> columns;
  for (const auto& [key, draw] : dataset.draws) {
    const bool of_each = key.starts_with("distractors.") && key != "distractors.count";
    if (of_each || draw.least.empty()) continue;
    const ParquetType type = draw.least.size() > 1                       ? ParquetType::float64_list
                             : draw.distribution.starts_with("{integer") ? ParquetType::int64
                                                                         : ParquetType::float64;
    columns.push_back({std::string(k_draws) + key, type});
  }
  return columns;
}

nlohmann::json value_of(const DrawRecords& draws, const ParquetFile::Column& column) {
  const auto at = draws.find(column.name.substr(k_draws.size()));
  if (at == draws.end()) return {};
  const std::vector<double>& values = at->second.values;
  if (column.type == ParquetType::float64_list) return values;
  if (column.type == ParquetType::int64) return static_cast<std::int64_t>(values.front());
  return values.front();
}

/// As a card has it, which is not as the library's own JSON does.
nlohmann::json hub_feature(const ParquetFile::Column& column, const ExportInput& input,
                           bool named_labels) {
  nlohmann::json feature{{"name", column.name}};
  if (column.name == "label" && named_labels) {
    nlohmann::json names = nlohmann::json::object();
    for (std::size_t i = 0; i < input.classes.size(); ++i)
      names[std::to_string(i)] = input.classes[i];
    feature["dtype"] = {{"class_label", {{"names", names}}}};
    return feature;
  }
  switch (column.type) {
    case ParquetType::text:
      feature["dtype"] = "string";
      break;
    case ParquetType::int64:
      feature["dtype"] = "int64";
      break;
    case ParquetType::float64:
      feature["dtype"] = "float64";
      break;
    case ParquetType::image:
      feature["dtype"] = "image";
      break;
    case ParquetType::int64_list:
      feature["sequence"] = "int64";
      break;
    case ParquetType::float64_list:
      feature["sequence"] = "float64";
      break;
    case ParquetType::float64_matrix:
      feature["sequence"] = {{"sequence", "float64"}};
      break;
  }
  return feature;
}

}  // namespace

std::vector<ParquetFile::Column> sample_columns(const ExportInput& input) {
  std::vector<ParquetFile::Column> columns;
  for (const auto& [name, type] : k_fields)
    columns.push_back({name, type});
  if (has_folds(input.dataset)) columns.push_back({"fold", ParquetType::int64});
  if (input.has("mask")) columns.push_back({"bbox", ParquetType::int64_list});
  if (input.has("mask")) columns.push_back({"truncation", ParquetType::float64});
  if (input.has("mask") && input.has("amodal_mask"))
    for (const char* name : {"visible_fraction", "occlusion"})
      columns.push_back({name, ParquetType::float64});
  for (const ParquetFile::Column& column : draw_columns(input.dataset))
    columns.push_back(column);
  return columns;
}

nlohmann::json hub_fields(const ExportInput& input, const ExportImage& image) {
  nlohmann::json fields = sample_fields(input, image);
  fields.erase("draws");
  for (const ParquetFile::Column& column : draw_columns(input.dataset))
    fields[column.name] = value_of(image.record.draws, column);
  return fields;
}

std::string hub_lines(const ExportInput& input, const std::vector<ParquetFile::Column>& columns,
                      const std::map<std::string, std::uint64_t>& bytes,
                      const std::map<std::string, std::string>& paths, bool named_labels) {
  nlohmann::json features = nlohmann::json::array(), splits = features, files = features;
  for (const ParquetFile::Column& column : columns)
    features.push_back(hub_feature(column, input, named_labels));
  std::uint64_t all = 0;
  for (const auto& [own_name, images] : input.splits) {
    // What the library makes of folders and files called val.
    const std::string split = own_name == "val" ? "validation" : own_name;
    const auto at = bytes.find(own_name);
    const std::uint64_t size = at == bytes.end() ? 0 : at->second;
    all += size;
    splits.push_back({{"name", split}, {"num_bytes", size}, {"num_examples", images}});
    files.push_back({{"split", split}, {"path", paths.at(own_name)}});
  }
  return fmt::format(
      "dataset_info: {}\nconfigs: {}\n",
      canonical_json({{"features", features},
                      {"splits", splits},
                      {"download_size", all},
                      {"dataset_size", all}}),
      canonical_json(nlohmann::json::array({{{"config_name", "default"}, {"data_files", files}}})));
}

}  // namespace ds

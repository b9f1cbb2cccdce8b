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
};

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
  return columns;
}

std::string hub_lines(const ExportInput& input, const std::vector<ParquetFile::Column>& columns,
                      const std::map<std::string, std::uint64_t>& bytes,
                      const std::map<std::string, std::string>& paths, bool named_labels) {
  nlohmann::json features = nlohmann::json::array(), splits = features, files = features;
  for (const ParquetFile::Column& column : columns)
    features.push_back(hub_feature(column, input, named_labels));
  std::uint64_t all = 0;
  for (const auto& [split, images] : input.splits) {
    const auto at = bytes.find(split);
    const std::uint64_t size = at == bytes.end() ? 0 : at->second;
    all += size;
    splits.push_back({{"name", split}, {"num_bytes", size}, {"num_examples", images}});
    files.push_back({{"split", split}, {"path", paths.at(split)}});
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

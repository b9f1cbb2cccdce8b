// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"
#include "manifests/export/parquet_file.h"

#include <map>
#include <string>
#include <vector>

namespace ds {

/// What hub_fields gives besides id and split, with its type; of a dataset with masks also bbox, with folds
/// fold, and a column for each key that is drawn, but for what is drawn for each distractor.
std::vector<ParquetFile::Column> sample_columns(const ExportInput& input);

/// sample_fields with what is drawn by columns, "draws.camera.fov_deg", in the place of an object; null where
/// the image has no such draw.
nlohmann::json hub_fields(const ExportInput& input, const ExportImage& image);

/// Lines of a card's front matter that Hugging Face's datasets reads: dataset_info (features, and of each split
/// images and bytes) and configs. JSON, which is YAML. `paths`: of each split, where its files are.
/// `named_labels`: whether the files tell the labels' names, and not their numbers alone.
std::string hub_lines(const ExportInput& input, const std::vector<ParquetFile::Column>& columns,
                      const std::map<std::string, std::uint64_t>& bytes,
                      const std::map<std::string, std::string>& paths, bool named_labels);

}  // namespace ds

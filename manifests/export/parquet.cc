// SPDX-License-Identifier: Apache-2.0
// Apache Parquet as Hugging Face's hub has it: data/SPLIT-%05d.parquet, files of up to 500 MB, pictures in
// them. The footer tells the features, so that labels have their classes' names.
#include "manifests/export/hub_features.h"
#include "manifests/export/parquet_export.h"
#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

namespace ds {
namespace {

constexpr std::uint64_t k_file_bytes = 400'000'000;

nlohmann::json feature(ParquetType type) {
  const auto value = [](const char* dtype) {
    return nlohmann::json{{"dtype", dtype}, {"_type", "Value"}};
  };
  const auto list = [](nlohmann::json of) {
    return nlohmann::json{{"feature", std::move(of)}, {"_type", "Sequence"}};
  };
  switch (type) {
    case ParquetType::text:
      return value("string");
    case ParquetType::int64:
      return value("int64");
    case ParquetType::float64:
      return value("float64");
    case ParquetType::image:
      return {{"_type", "Image"}};
    case ParquetType::int64_list:
      return list(value("int64"));
    case ParquetType::float64_list:
      return list(value("float64"));
    case ParquetType::float64_matrix:
      return list(list(value("float64")));
  }
  return {};
}

}  // namespace

Parquet::Parquet(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {
  columns_.push_back({"id", ParquetType::text});
  for (const std::string& kind : input.kinds) {
    if (is_exr(kind)) {
      to.note(fmt::format("{} is EXR, which readers of this format cannot decode: left out", kind));
      continue;
    }
    kinds_.push_back(kind);
    columns_.push_back({kind, ParquetType::image});
  }
  for (const ParquetFile::Column& column : sample_columns(input))
    columns_.push_back(column);
  nlohmann::json features;
  for (const auto& [name, type] : columns_)
    features[name] = feature(type);
  features["label"] = {{"names", input.classes}, {"_type", "ClassLabel"}};
  info_ = canonical_json({{"info", {{"features", features}}}});
}

void Parquet::add(const ExportImage& image) {
  std::vector<ParquetImage> images;
  for (const std::string& kind : kinds_) {
    const FileRecord& file = file_of(image, kind);
    images.push_back({place_of_kind(image, kind), read_checked(input_.folder, file)});
    bytes_[image.split] += file.hashes.size_bytes;
  }
  Split& split = splits_[image.split];
  if (split.file && split.file->bytes() > k_file_bytes) {
    split.file->close();
    split.file.reset();
  }
  if (!split.file)
    split.file = std::make_unique<ParquetFile>(
        to_, fmt::format("data/{}-{:05}.parquet", image.split, split.number++), columns_, info_);
  split.file->add(hub_fields(input_, image), images);
}

void Parquet::finish() {
  for (auto& [name, split] : splits_)
    split.file->close();
}

std::string Parquet::card_lines() const {
  std::map<std::string, std::string> paths;
  for (const auto& [split, images] : input_.splits)
    paths[split] = fmt::format("data/{}-*.parquet", split);
  return hub_lines(input_, columns_, bytes_, paths, true);
}

bool Parquet::is_exr(const std::string& kind) const {
  for (const auto& [name, plane] : input_.dataset.planes)
    if (name == kind) return plane.encoding == "exr" || plane.encoding == "half";
  return false;
}

ExporterType parquet_exporter() {
  return {
      "parquet", "Apache Parquet with the pictures in it: load_dataset(\"parquet\", data_dir=...)",
      {"image"}, {},
      true,      make_exporter<Parquet>};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Hugging Face datasets' ImageFolder: SPLIT/metadata.jsonl, whose file_name becomes the feature "image"
// and NAME_file_name the image feature NAME. Planes that are no PNG cannot be such features: they get
// their path.
#include "manifests/export/exporter.h"
#include "manifests/export/hub_features.h"
#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

namespace ds {
namespace {

class ImageFolder : public Exporter {
 public:
  ImageFolder(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {
    for (const auto& [split, count] : input.splits)
      lines_.emplace(split, std::make_unique<ExportFolder::Stream>(to, split + "/metadata.jsonl"));
  }

  void add(const ExportImage& image) override {
    nlohmann::json fields = hub_fields(input_, image);
    std::string picture;
    for (const std::string& kind : input_.kinds) {
      const std::string path = place_of_kind(image, kind);
      to_.place(file_of(image, kind), image.split + "/" + path);
      const bool png = path.ends_with(".png");
      if (!png) exr_kinds_.insert(kind);
      bytes_[image.split] += file_of(image, kind).hashes.size_bytes;
      if (kind == "image")
        picture = path;
      else
        fields[kind + (png ? "_file_name" : "_path")] = path;
    }
    // First, before any albedo_file_name: to the first of these that it meets the library gives file_name.
    lines_.at(image.split)
        ->write(fmt::format("{{\"file_name\":{},{}\n", canonical_json(picture),
                            canonical_json(fields).substr(1)));
  }

  std::string card_lines() const override {
    std::vector<ParquetFile::Column> columns;
    for (const std::string& kind : input_.kinds)
      columns.push_back(exr_kinds_.contains(kind)
                            ? ParquetFile::Column{kind + "_path", ParquetType::text}
                            : ParquetFile::Column{kind, ParquetType::image});
    for (const char* name : {"id", "split"})
      columns.push_back({name, ParquetType::text});
    for (const ParquetFile::Column& column : sample_columns(input_))
      columns.push_back(column);
    std::map<std::string, std::string> paths;
    for (const auto& [split, images] : input_.splits)
      paths[split] = split + "/**";
    return hub_lines(input_, columns, bytes_, paths, false);
  }

  void finish() override {
    for (const auto& [split, lines] : lines_)
      lines->close();
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  std::set<std::string> exr_kinds_;
  std::map<std::string, std::uint64_t> bytes_;  ///< of each split's files
  std::map<std::string, std::unique_ptr<ExportFolder::Stream>> lines_;
};

}  // namespace

ExporterType imagefolder_exporter() {
  return {"imagefolder", "Hugging Face ImageFolder: load_dataset(\"imagefolder\", data_dir=...)",
          {"image"},     {},
          true,          make_exporter<ImageFolder>};
}

}  // namespace ds

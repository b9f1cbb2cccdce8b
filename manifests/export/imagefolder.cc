// SPDX-License-Identifier: Apache-2.0
// Hugging Face datasets' ImageFolder: SPLIT/metadata.jsonl, whose file_name becomes the feature "image"
// and NAME_file_name the image feature NAME. Planes that are no PNG cannot be such features: they get
// their path.
#include "manifests/export/exporter.h"
#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"

namespace ds {
namespace {

class ImageFolder : public Exporter {
 public:
  ImageFolder(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {
    for (const auto& [split, count] : input.splits)
      lines_.emplace(split, std::make_unique<ExportFolder::Stream>(to, split + "/metadata.jsonl"));
  }

  void add(const ExportImage& image) override {
    nlohmann::json fields = sample_fields(input_, image);
    for (const std::string& kind : input_.kinds) {
      const std::string path = place_of_kind(image, kind);
      to_.place(file_of(image, kind), image.split + "/" + path);
      const bool png = path.ends_with(".png");
      fields[kind == "image" ? "file_name" : kind + (png ? "_file_name" : "_path")] = path;
    }
    lines_.at(image.split)->write(canonical_json(fields) + "\n");
  }

  void finish() override {
    for (const auto& [split, lines] : lines_)
      lines->close();
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  std::map<std::string, std::unique_ptr<ExportFolder::Stream>> lines_;
};

}  // namespace

ExporterType imagefolder_exporter() {
  return {"imagefolder", "Hugging Face ImageFolder: load_dataset(\"imagefolder\", data_dir=...)",
          {"image"},     {},
          true,          make_exporter<ImageFolder>};
}

}  // namespace ds

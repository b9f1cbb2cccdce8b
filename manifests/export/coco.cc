// SPDX-License-Identifier: Apache-2.0
// COCO detection and segmentation: annotations/instances_SPLIT.json, images/SPLIT/KEY.png. Masks are run
// lengths: polygons would lose their holes. What an image shows nothing of, or what has no class, has no
// annotation.
#include "manifests/export/exporter.h"
#include "manifests/export/run_lengths.h"
#include "manifests/export/shown_objects.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

#include <utility>

namespace ds {
namespace {

/// The parts of one annotation file that grow with the images.
struct Parts {
  std::string images, annotations;
};

void append(std::string& list, const nlohmann::json& object) {
  list += (list.empty() ? "" : ",\n") + canonical_json(object);
}

class Coco : public Exporter {
 public:
  Coco(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {}

  void add(const ExportImage& image) override {
    Parts& parts = parts_[image.split];
    const ImageRecord& record = image.record;
    ++image_id_;
    const std::string name = image.key + ending_of(file_of(image, "image"));
    to_.place(file_of(image, "image"), "images/" + image.split + "/" + name);
    append(parts.images, {{"id", image_id_},
                          {"file_name", name},
                          {"width", record.width},
                          {"height", record.height},
                          {"license", 1},
                          {"dsbuild_id", record.id}});
    for (const ListedObject& object : shown_objects(input_, image))
      annotate(parts, object);
  }

  void annotate(Parts& parts, const ListedObject& object) {
    const MaskPixels& mask = object.mask;
    const auto box = tight_box(mask);
    if (!box) {
      to_.note(object.record == nullptr
                   ? "images whose mask shows nothing have no annotation"
                   : "distractors of which nothing is seen have no annotation");
      return;
    }
    if (object.label < 0) {
      to_.note("distractors without a class have no annotation");
      return;
    }
    append(
        parts.annotations,
        {{"id", ++annotation_id_},
         {"image_id", image_id_},
         {"category_id", object.label + 1},
         {"iscrowd", 0},
         {"area", static_cast<double>(area_of(mask))},
         {"bbox", std::vector<double>(box->begin(), box->end())},
         {"segmentation",
          {{"size", {mask.height, mask.width}}, {"counts", run_length_text(run_lengths(mask))}}}});
  }

  void finish() override {
    std::string categories;
    for (std::size_t i = 0; i < input_.classes.size(); ++i) {
      const std::string& path = input_.classes[i];
      const std::size_t slash = path.rfind('/');
      append(categories, {{"id", i + 1},
                          {"name", path},
                          {"supercategory", slash == path.npos ? "" : path.substr(0, slash)}});
    }
    const DatasetRecord& dataset = input_.dataset;
    const std::string info = canonical_json(
        {{"description", dataset.name}, {"version", dataset.dsbuild_version}, {"year", 0}});
    const std::string licence = canonical_json({{"id", 1}, {"name", dataset.licence}, {"url", ""}});
    for (const auto& [split, parts] : parts_)
      to_.write(
          "annotations/instances_" + split + ".json",
          fmt::format("{{\"info\":{},\n\"licenses\":[{}],\n\"categories\":[{}],\n\"images\":[{}],\n"
                      "\"annotations\":[{}]}}\n",
                      info, licence, categories, parts.images, parts.annotations));
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  std::map<std::string, Parts> parts_;
  std::uint64_t image_id_ = 0, annotation_id_ = 0;
};

}  // namespace

ExporterType coco_exporter() {
  return {"coco",
          "COCO: annotations/instances_SPLIT.json with boxes and masks, images/SPLIT",
          {"image", "mask"},
          {"image", "mask"},
          true,
          make_exporter<Coco>,
          true};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// YOLO detection as Ultralytics reads it: data.yaml, images/SPLIT/KEY.png, labels/SPLIT/KEY.txt with
// "class cx cy w h" in shares of the picture. An image whose mask shows nothing has an empty file.
#include "manifests/export/exporter.h"
#include "manifests/json_text.h"

namespace ds {
namespace {

class Yolo : public Exporter {
 public:
  Yolo(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {}

  void add(const ExportImage& image) override {
    to_.place(file_of(image, "image"), fmt::format("images/{}/{}{}", image.split, image.key,
                                                   ending_of(file_of(image, "image"))));
    const MaskPixels mask = read_mask(input_, image);
    std::string line;
    if (const auto box = tight_box(mask)) {
      const std::array<double, 4> edges{double((*box)[0]), double((*box)[1]), double((*box)[2]),
                                        double((*box)[3])};
      const auto [x, y, w, h] = edges;
      line = fmt::format("{} {} {} {} {}\n", image.label, (x + 0.5 * w) / mask.width,
                         (y + 0.5 * h) / mask.height, w / mask.width, h / mask.height);
    }
    to_.write(fmt::format("labels/{}/{}.txt", image.split, image.key), line);
  }

  /// Without "path", which would count from the reader's working folder. Readers want train and val.
  void finish() override {
    const std::string first =
        input_.splits.contains("train") ? "train" : input_.splits.begin()->first;
    const std::string last =
        input_.splits.contains("test") ? "test" : input_.splits.rbegin()->first;
    if (first != last && last == "test")
      to_.note("data.yaml names the test split for val too, which readers want");
    if (first == last)
      to_.note(
          fmt::format("there is one split only: data.yaml names {} for train and for val", first));
    std::string text = fmt::format("train: images/{}\nval: images/{}\n", first, last);
    if (last == "test") text += "test: images/test\n";
    text += "names:\n";
    for (std::size_t i = 0; i < input_.classes.size(); ++i)
      text += fmt::format("  {}: {}\n", i, canonical_json(input_.classes[i]));
    to_.write("data.yaml", text);
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
};

}  // namespace

ExporterType yolo_exporter() {
  return {"yolo",
          "YOLO detection: data.yaml, images/SPLIT, labels/SPLIT",
          {"image", "mask"},
          {"image", "mask"},
          true,
          make_exporter<Yolo>};
}

}  // namespace ds

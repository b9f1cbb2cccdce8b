// SPDX-License-Identifier: Apache-2.0
// YOLO as Ultralytics reads it: data.yaml, images/SPLIT/KEY.png, labels/SPLIT/KEY.txt with "class cx cy w h"
// (detection) or "class x y x y ..." (segmentation) in shares of the picture. An image whose mask shows nothing
// has an empty file.
#include "manifests/export/yolo.h"

#include "manifests/export/shown_objects.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

namespace ds {
namespace {

std::string box_line(const MaskPixels& mask) {
  const auto box = *tight_box(mask);
  const std::array<double, 4> edges{double(box[0]), double(box[1]), double(box[2]), double(box[3])};
  const auto [x, y, w, h] = edges;
  return fmt::format(" {} {} {} {}", (x + 0.5 * w) / mask.width, (y + 0.5 * h) / mask.height,
                     w / mask.width, h / mask.height);
}

}  // namespace

void Yolo::add(const ExportImage& image) {
  to_.place(file_of(image, "image"), fmt::format("images/{}/{}{}", image.split, image.key,
                                                 ending_of(file_of(image, "image"))));
  std::string lines;
  for (const ListedObject& object : shown_objects(input_, image)) {
    if (object.label < 0)
      to_.note("distractors without a class have no label");
    else if (tight_box(object.mask))
      lines += fmt::format("{}{}\n", object.label, line_(object.mask));
  }
  to_.write(fmt::format("labels/{}/{}.txt", image.split, image.key), lines);
}

/// Without "path", which would count from the reader's working folder. Readers want train and val.
void Yolo::finish() {
  // In place of one that is not there stands what is nearest to its use.
  const auto there = [&](std::initializer_list<const char*> splits) {
    return std::string(*std::find_if(splits.begin(), splits.end(), [&](const char* split) {
      return input_.splits.contains(split);
    }));
  };
  const std::string train = there({"train", "val", "test"}), val = there({"val", "test", "train"});
  if (input_.splits.size() == 1)
    to_.note(
        fmt::format("there is one split only: data.yaml names {} for train and for val", train));
  else if (train != "train" || val != "val")
    to_.note(fmt::format("data.yaml names the {} split for {} too, which readers want",
                         val == "val" ? train : val, val == "val" ? "train" : "val"));
  std::string text = fmt::format("train: images/{}\nval: images/{}\n", train, val);
  if (input_.splits.contains("test")) text += "test: images/test\n";
  text += "names:\n";
  for (std::size_t i = 0; i < input_.classes.size(); ++i)
    text += fmt::format("  {}: {}\n", i, canonical_json(input_.classes[i]));
  to_.write("data.yaml", text);
}

ExporterType yolo_exporter() {
  return {"yolo",
          "YOLO detection: data.yaml, images/SPLIT, labels/SPLIT",
          {"image", "mask"},
          {"image", "mask"},
          true,
          [](const ExportInput& input, ExportFolder& to) -> std::unique_ptr<Exporter> {
            return std::make_unique<Yolo>(input, to, box_line);
          },
          true,
          "A line of labels is of one thing: its class and the middle, width and height of its "
          "box, x and y from the picture's top left "
          "corner as shares of its width and height."};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// YOLO segmentation: yolo.cc's files with an object's outline for its box. Readers take one polygon an object,
// so that pieces and holes are tied to the rest.
#include "manifests/export/outlines.h"
#include "manifests/export/yolo.h"

#include <fmt/format.h>

#include <iterator>

namespace ds {
namespace {

std::string outline_line(const MaskPixels& mask) {
  std::string line;
  for (const auto& [x, y] : outline_of(mask))
    fmt::format_to(std::back_inserter(line), " {} {}", double(x) / mask.width,
                   double(y) / mask.height);
  return line;
}

}  // namespace

ExporterType yolo_seg_exporter() {
  return {"yolo_seg",
          "YOLO segmentation: as yolo, with outlines in place of boxes",
          {"image", "mask"},
          {"image", "mask"},
          true,
          [](const ExportInput& input, ExportFolder& to) -> std::unique_ptr<Exporter> {
            return std::make_unique<Yolo>(input, to, outline_line);
          },
          true,
          "A line of labels is of one thing: its class and the corners of its outline, x and y "
          "from the picture's top left "
          "corner as shares of its width and height."};
}

}  // namespace ds

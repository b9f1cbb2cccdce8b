// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

#include <string>

namespace ds {

/// YOLO's folders and data.yaml; what a line of a label says of a mask differs.
class Yolo : public Exporter {
 public:
  /// Behind the class, of a mask that is not empty.
  using Line = std::string (*)(const MaskPixels& mask);
  Yolo(const ExportInput& input, ExportFolder& to, Line line)
      : input_(input), to_(to), line_(line) {}

  void add(const ExportImage& image) override;
  void finish() override;

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  Line line_;
};

}  // namespace ds

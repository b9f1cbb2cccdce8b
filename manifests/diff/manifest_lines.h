// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace ds {

/// The lines of a folder's manifest/images.jsonl, one after the other, by ascending id. Throws as
/// read_images_manifest, and Error(asset) for a line whose id is not behind the one before.
class ManifestLines {
 public:
  /// At the first line.
  explicit ManifestLines(std::filesystem::path folder);
  void next();
  bool at_end() const { return at_end_; }
  /// Of the line it is at: without its line break.
  const std::string& text() const { return text_; }
  const std::string& id() const { return id_; }
  ImageRecord record() const;

 private:
  std::string id_of_line() const;

  std::filesystem::path folder_, file_;
  std::ifstream in_;
  std::string text_, id_;
  int number_ = 0;
  bool at_end_ = false;
};

}  // namespace ds

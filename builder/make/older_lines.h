// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest_glance.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// A line of the manifest before.
struct OlderLine {
  OlderLine() = default;
  explicit OlderLine(ImageRecord record);

  std::string text;   ///< without its line break
  LineGlance glance;  ///< views `text`, or the record it was made from

  /// The whole line. Throws Error(asset) where it is none.
  ImageRecord record() const;

 private:
  friend class OlderLines;
  std::optional<ImageRecord> record_;
};

/// The lines of the manifest that stands in a folder, by ascending id.
class OlderLines {
 public:
  /// An empty folder, or one without a manifest: none. `as_written`: the file is known to be as a
  /// dsbuild wrote it; it is then read line by line. Else it is read and checked whole; a damaged
  /// one is a warning and has none.
  OlderLines(const std::filesystem::path& folder, bool as_written);

  /// Holds until the next call; null at the end. Throws Error(io).
  const OlderLine* next();

 private:
  const OlderLine* next_read();

  std::filesystem::path file_;
  std::ifstream in_;
  std::vector<ImageRecord> records_;  ///< where the file was read whole
  std::size_t next_ = 0;
  OlderLine line_;
};

}  // namespace ds

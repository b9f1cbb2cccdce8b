// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"
#include "manifests/manifest_glance.h"
#include "tracer/base/file_writer.h"
#include "tracer/base/hash_stream.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// Writes a manifest line by line, for datasets whose lines are not held all at once. Until `finish`
/// the one that stands stays.
class ManifestWriter {
 public:
  explicit ManifestWriter(const std::filesystem::path& folder);

  /// In ascending order of ids: Error(asset) otherwise, and for a path that no manifest may hold.
  void add(std::string_view line, const LineGlance& image);
  /// As `write_manifest`. An images.jsonl of the bytes that stand is not written again.
  void finish(const DatasetRecord& dataset);

 private:
  std::filesystem::path folder_;
  FileWriter images_;
  HashStream hash_;
  std::string last_id_;
  bool any_ = false;
  std::vector<std::pair<std::string, Hash128>> checksums_;
};

}  // namespace ds

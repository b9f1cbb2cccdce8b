// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// What the files of a gallery were made of, so that the next one makes only what is new. A text file:
///
///   dsbuild gallery 1
///   <use> <source's XXH3-128> <file's XXH3-128> <path> <facts>      a line each, ordered
///
/// Use: "thumbnail", "box", or a plane's name of a preview. Where no file is made, hash and path are
/// "-". Facts: numbers with commas between, or "-". The number counts up when anything is made in
/// another way; a record of another number is as none.
class MadeRecord {
 public:
  struct Row {
    Hash128 hash;
    std::string path;  ///< empty: no file
    std::vector<double> facts{};
  };

  MadeRecord() = default;
  /// Of a gallery's folder; empty where there is none, or none that can be read.
  explicit MadeRecord(const std::filesystem::path& folder);

  /// Null where nothing was made of it.
  const Row* find(std::string_view use, Hash128 source) const;
  /// The first of several of one use and source stays.
  void add(std::string_view use, Hash128 source, Row&& row);
  std::string text() const;

 private:
  std::map<std::pair<std::string, Hash128>, Row, std::less<>> rows_;
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A class of a .cla file.
struct ModelClass {
  std::string name;
  int parent = -1;                  ///< index of an earlier class, or -1 where the file says "0"
  std::vector<std::string> models;  ///< as written: a number ("1298") or a file name ("mug.ply")
};

/// A Princeton Shape Benchmark classification file.
struct Classification {
  std::vector<ModelClass> classes;  ///< in file order, parents first
  int model_count = 0;

  /// "vehicle/car": the names from the root down, joined by "/".
  std::string path(int class_index) const;
  int leaf_count() const;  ///< classes that hold models
};

/// Throws Error(asset), all findings with file:line: bad header, wrong counts, unknown parent, a class twice, a model in
/// two leaf classes.
Classification parse_classification(std::string_view text, const std::string& name);
Classification read_classification(const std::filesystem::path& file);

/// Class and split of a model by its file name ("m1298.off" and "1298.off" match "1298"; "mug.ply" matches "mug.ply"
/// and "mug").
struct ModelLabel {
  std::string class_path, split;
};
class Labels {
 public:
  Labels() = default;
  /// Throws Error(asset) where one model stands in both. Either may be absent.
  Labels(const std::optional<Classification>& train, const std::optional<Classification>& test);
  std::optional<ModelLabel> find(std::string_view model_file_name) const;

 private:
  std::vector<std::pair<std::string, ModelLabel>> sorted_;
};

}  // namespace ds

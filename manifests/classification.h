// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <cstddef>
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
  std::vector<int> model_lines;     ///< as long as models: where each stands, from 1
};

/// A Princeton Shape Benchmark classification file. The text, by lines (blank ones anywhere, CRLF
/// or LF):
///
///   file  := "PSB 1" EOL  class_count model_count EOL  class*
///   class := name parent count EOL  (model EOL){count}      parent: the name of an earlier class,
///   or "0" for none
///
/// A class's name is one word, and a model's, but for a file name with its ending, in which blanks may
/// stand ("coffee mug.ply"; each as one blank). Names are unique, so that a parent's name is enough to
/// tell it.
struct Classification {
  std::string file;                 ///< as given to the reader, for messages
  std::vector<ModelClass> classes;  ///< in file order, parents first
  int model_count = 0;              ///< in all classes together

  /// "vehicle/car": the names from the root down, joined by "/".
  std::string path(int class_index) const;
  /// Classes that hold models (a few of the benchmark's are parents too).
  int leaf_count() const;
};

/// Throws Error(asset), all findings with file:line: bad header, wrong counts, unknown parent, a
/// class twice, a model twice (in one class or in two), a line that is neither a class nor a model.
Classification parse_classification(std::string_view text, const std::string& name);
/// `file` stands in messages as given. Throws Error(io) where it cannot be read.
Classification read_classification(const std::filesystem::path& file);

/// "train", "val" or "test" for what people call these, in any case: "training", "validation", "dev",
/// "eval", ...; "" for any other name.
std::string_view split_named(std::string_view name);
/// "train, training, val, ... or evaluation": all that split_named knows.
std::string split_names_text();

/// Whether it is names with / between, none empty, 0, . or .. or with control characters; "" is, too: no class.
bool is_class_path(std::string_view path);

struct ModelLabel {
  std::string class_path;  ///< "vehicle/car"; "" for none
  std::string split;       ///< "train", "val" or "test"; "" for none
  bool operator==(const ModelLabel&) const = default;
};

/// A model as a list of models calls it, and what it says of it.
struct LabelledModel {
  std::string model;
  ModelLabel label;
  SourcePlace place;  ///< where the list says so; no file where no list does
};
/// Those of a class file, all in one split.
std::vector<LabelledModel> labelled_models(const Classification& from, const std::string& split);

/// Classes that have models in one of two class files and none in the other: what is left where a
/// class was renamed in one of them.
struct UnsharedClasses {
  std::vector<std::string> classes;  ///< "vehicle/car (train)", sorted; of absent files: none
  std::size_t of = 0;                ///< classes with models in either; 0 where one is absent
};
UnsharedClasses unshared_classes(const std::optional<Classification>& train,
                                 const std::optional<Classification>& test);

/// Class and split of a model by its name.
class Labels {
 public:
  Labels() = default;
  /// Throws Error(asset), all findings with file:line, where one model stands in both. Either may
  /// be absent.
  Labels(const std::optional<Classification>& train, const std::optional<Classification>& test);

  /// Of a list that names no model twice.
  explicit Labels(const std::vector<LabelledModel>& models);

  /// A class file's "mug.ply" means the file of that name, "mug" any file of that stem, "1298" also
  /// "m1298.off" (the benchmark's own naming). A model named by its path ("a/mug.ply") is meant by that
  /// path, with or without its ending, and by what means its file. Where several would do, the first in
  /// this order counts: path, path less its ending, file name, stem, number.
  std::optional<ModelLabel> find(std::string_view model_name) const;
  /// Which of the entries `find` would use, below size().
  std::optional<std::size_t> find_index(std::string_view model_name) const;
  /// All entries that mean the file: the one that `find` uses, and then those it goes before.
  std::vector<std::size_t> find_all(std::string_view model_name) const;
  std::size_t size() const { return sorted_.size(); }
  /// What the list says in the entry of that index.
  const LabelledModel& entry(std::size_t index) const { return sorted_.at(index); }
  const std::string& name(std::size_t index) const { return entry(index).model; }
  const ModelLabel& label(std::size_t index) const { return entry(index).label; }
  /// Whether any entry has a split.
  bool has_splits() const;
  /// The paths of all classes that entries have, and of those above them, sorted, each once.
  std::vector<std::string> class_paths() const;

 private:
  void add(const std::vector<LabelledModel>& models);
  std::optional<std::size_t> index_of(std::string_view key) const;

  std::vector<LabelledModel> sorted_;  // by model
};

/// The paths of all classes of both files and of their parents, sorted, each once.
std::vector<std::string> class_paths(const std::optional<Classification>& train,
                                     const std::optional<Classification>& test);

}  // namespace ds

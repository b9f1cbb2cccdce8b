// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ds {

struct ImportRequest {
  std::filesystem::path from;  ///< a folder of models, in whatever folders
  std::filesystem::path to;    ///< becomes the folder of the recipe
  bool copy = false;           ///< the models, into `to`; else the recipe names where they lie
  /// Without class files: "folders", all that a model lies in, or "folder", the first of them, as where each
  /// model has one of its own.
  std::string classes = "folders";
  bool split_folders = true;  ///< folders called train, val, test tell splits (SplitFolders)
  bool update = false;        ///< `to` is an import's, and gets what is new of `from`
};

struct ImportResult {
  std::filesystem::path recipe;
  std::uint64_t models = 0;
  std::map<std::string, std::uint64_t> splits;  ///< models of each; "" is none
  std::vector<std::string> classes;             ///< by id
  std::vector<std::string> single;  ///< of these, where folders are classes, those of one model
  std::vector<std::string> hierarchies;  ///< further classifications
  /// Files that cannot be used, and why: left out.
  std::vector<std::pair<std::string, std::string>> broken;
  std::vector<std::string> mended;        ///< models with damage that was mended
  std::vector<std::string> missing;       ///< in class files, and no file here
  std::vector<std::string> unclassified;  ///< models without a class
  std::vector<std::string>
      own;  ///< models with materials of their own, all files of which are there
  /// Models whose own materials cannot be shown, and why: they are none of `own`.
  std::vector<std::pair<std::string, std::string>> own_broken;
  /// Folders that told splits, and which, and those called as if they did that are classes.
  std::map<std::string, std::string> split_folders;
  std::set<std::string> class_folders;
  // Of an update, which counts and names what is new above:
  bool updated = false;
  std::uint64_t kept = 0;  ///< models that were listed already
  std::vector<std::string> new_classes;
  std::vector<std::string> taken_out;  ///< whose lines were taken out of classes.csv by hand
  std::vector<std::string> gone;       ///< listed, and no file any more: their lines stay
  std::vector<std::string> unsplit;    ///< new ones without a split, where others have one
};

/// Writes a recipe for a folder of models, and what it needs: classes.csv, ids.txt, more/*.csv of
/// further classifications, and the shipped materials and environments. Every model is read. Where
/// `from` holds class files (.cla), as the Princeton Shape Benchmark does, classes and splits are theirs
/// (of several classifications "base" comes first, or else that of most classes, and the others are
/// further ones); else a model's class are the folders it lies in. With `copy`, what models' own
/// materials are in goes with them, where it lies in `from`. The recipe is written last; an import
/// that was cut short is done again.
///
/// With `update`, models that are not in its classes.csv get lines at its end, their classes lines at the end of
/// ids.txt, and further classifications likewise; where it has copies of models they are copied there, too.
/// Nothing else is touched: no line of a file that is there, neither recipe nor materials.
///
/// Throws Error(usage) where `from` holds no model, `to` is taken or is nothing to update,
/// Error(asset) where no model can be used, Error(cancelled) once `stop`. `progress`: models read of all.
ImportResult import_models(const ImportRequest& request,
                           const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                           const std::atomic<bool>& stop);

/// The folder of the materials and environments that come with this program: beside it, in
/// ../share/dsbuild, or where it was built. Throws Error(io) where there is none.
std::filesystem::path shipped_assets();

}  // namespace ds

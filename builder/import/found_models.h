// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/import/class_sources.h"
#include "builder/import/import.h"
#include "builder/recipe/recipe.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace ds {

/// The models that an import finds.
struct FoundModels {
  Recipe recipe;  ///< its models have paths in the folder for names; classes and splits are labels
  bool has_files = false;  ///< classes come from class files, not from folders
  std::vector<const ModelFile*> good;
  std::set<const ModelFile*> own;  ///< with materials of their own
};

using ImportProgress = std::function<void(std::uint64_t, std::uint64_t)>;

/// As recipes read the folder; nothing is `good` yet.
FoundModels find_models_to_import(const ImportRequest& request);
/// Reads those models: `good` are those that can be used, and `result` tells of the others, and what else reading
/// told. Throws Error(cancelled) once `stop`.
void look_at_models(FoundModels& found, const std::vector<const ModelFile*>& models,
                    const ImportProgress& progress, const std::atomic<bool>& stop,
                    ImportResult& result);
/// Which folders told splits, where folders did.
void tell_split_folders(const FoundModels& found, const ImportRequest& request,
                        ImportResult& result);
/// Class and split, where they may stand in a table.
ModelLabel label_of(const FoundModels& found, const ModelFile& model);
/// Whether two of the models have one file name.
bool share_file_names(const std::vector<ModelFile>& models);
/// A field of comma-separated values, as RFC 4180 has it.
std::string csv_field(const std::string& text);
/// The good ones into models of the recipe's folder, with what belongs to them.
void copy_models(const ImportRequest& request, const FoundModels& found);

/// Names of the models that were imported into a folder, a line each: those that are not in its classes.csv any
/// more were taken out by hand.
inline constexpr const char* k_imported = ".dsbuild-imported";
/// Stands in the folder while it is filled: what lies there is then an import's own.
inline constexpr const char* k_import_begun = ".dsbuild-import";

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/recipe/recipe.h"
#include "builder/store/claims.h"
#include "builder/store/disk.h"
#include "builder/store/store.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ds {

struct SlurmMark;

/// Which dataset a command is about.
struct DatasetRequest {
  std::filesystem::path target;        ///< a recipe, or the folder an earlier build wrote
  std::vector<std::string> overrides;  ///< --set; only with a recipe
  /// -o; empty: out/<name>, or the target where it is a folder.
  std::filesystem::path output_folder;
  /// --store; empty: as before, at first <output folder>/.dsbuild.
  std::filesystem::path store_folder;
  bool adopt = false;  ///< --adopt: take the folder though it belongs to another recipe
  /// --database: where the store's database and locks are kept in place of the store; empty: in it.
  std::filesystem::path database_folder{};
  /// The folder is thrown away: the store is not told where it lies.
  bool in_passing = false;
  /// --local: Store::local; empty: none.
  std::filesystem::path local_folder{};
  /// Told of a mark in the store before Access::build opens a database in it, and throws where that is
  /// not to be; empty: never told.
  std::function<void(const SlurmMark& mark)> check_filled{};
};

enum class Access {
  look,     ///< makes no folder and no file; a dataset never built has an empty database in memory
  inputs,   ///< as look, whoever owns the folder: for what is about a recipe and its files only
  records,  ///< as look, without the recipe where a folder is given: for what was done before
  build,
};

/// A dataset's recipe, folder, store and database. The folder holds `.dsbuild/dataset`, which names
/// the dataset's id in the database, the store's folder (relative to `.dsbuild`, so that a dataset
/// can be moved with its own store) and the recipe the folder belongs to: the one at that place, or
/// at the same place seen from the folder, so that a project can be moved as a whole.
struct Dataset {
  Recipe recipe;
  std::filesystem::path folder;  ///< absolute
  DatasetRow row;
  std::filesystem::path lock_folder;  ///< where builds of the folder lock each other out
  std::unique_ptr<Claims> claims;     ///< null where there is no store yet, or no writing to it
  std::unique_ptr<Store> store;       ///< null where there is no store yet
  std::unique_ptr<Database> database;
};

/// A recipe's folder, where none is given, is out/<name> in the working folder; where nothing of the
/// recipe lies there, the nearest such folder above it or above the recipe that belongs to it.
/// Throws Error(usage) for a target that is neither, and for a folder that belongs to another
/// recipe; Error(recipe) for what `read_recipe` finds; Error(io).
Dataset open_dataset(const DatasetRequest& request, Access access, Disk& disk);

/// Where the last build of a dataset of a store that lies outside its folder left it; that folder, where
/// the store lies in it. Empty where an older dsbuild made it.
std::filesystem::path folder_of_dataset(const Store& store, const std::string& id);
/// Id and folder of every dataset of the store that is found where its last build left it.
std::vector<std::pair<std::string, std::filesystem::path>> datasets_beside(const Store& store);
/// Whether the dataset of that id lies there.
bool holds_dataset(const std::filesystem::path& folder, const std::string& id);

/// The dataset's folder; where that is what was asked for, without reading the recipe. For what
/// needs only the manifest.
std::filesystem::path dataset_folder(const DatasetRequest& request);

/// The recipe that a dataset's folder belongs to, where the folder is no longer where it was built
/// and the recipe did not move with it: a copy, which is not to be as the recipe wants it now.
std::optional<std::filesystem::path> recipe_left_behind(const std::filesystem::path& folder);

/// Whether a dataset's manifest lies there without the `.dsbuild` that a build puts beside it.
bool has_lost_state(const std::filesystem::path& folder);

/// The folder above `path` that a build wrote, and nothing where there is none.
std::optional<std::filesystem::path> enclosing_dataset(const std::filesystem::path& path);

}  // namespace ds

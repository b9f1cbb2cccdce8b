// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/build/claims.h"
#include "builder/build/disk.h"
#include "builder/build/store.h"
#include "builder/db/database.h"
#include "builder/recipe/recipe.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// Which dataset a command is about.
struct DatasetRequest {
  std::filesystem::path target;        ///< a recipe, or the folder an earlier build wrote
  std::vector<std::string> overrides;  ///< --set; only with a recipe
  std::filesystem::path
      output_folder;  ///< -o; empty: out/<name>, or the target where it is a folder
  std::filesystem::path
      store_folder;  ///< --store; empty: as before, at first <output folder>/.dsbuild
};

enum class Access {
  look,  ///< makes no folder and no file; a dataset never built has an empty database in memory
  build,
};

/// A dataset's recipe, folder, store and database. The folder holds `.dsbuild/dataset`, which names
/// the dataset's id in the database and the store's folder (relative to `.dsbuild`, so that a
/// dataset can be moved with its own store).
struct Dataset {
  Recipe recipe;
  std::filesystem::path folder;  ///< absolute
  DatasetRow row;
  std::unique_ptr<Claims> claims;  ///< null where there is no store yet
  std::unique_ptr<Store> store;    ///< null where there is no store yet
  std::unique_ptr<Database> database;
};

/// Throws Error(usage) for a target that is neither, Error(recipe) for what `read_recipe` finds,
/// Error(io).
Dataset open_dataset(const DatasetRequest& request, Access access, Disk& disk);

/// The dataset's folder without reading the recipe. For what needs only the manifest.
std::filesystem::path dataset_folder(const DatasetRequest& request);

/// The folder above `path` that a build wrote, and nothing where there is none.
std::optional<std::filesystem::path> enclosing_dataset(const std::filesystem::path& path);

}  // namespace ds

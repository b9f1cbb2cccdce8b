// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"

#include <filesystem>
#include <vector>

namespace ds {

/// Model files: models.files, or the files of models.dir that have a mesh format's ending (in any
/// case) but for hidden ones; sorted by name, which models.names chooses: the file's, or its path in
/// models.dir; of models.files as it is written there, less what leads out of the recipe's folder. Folders that links lead to are looked into as others are, each folder
/// once. What models.dir holds besides (files of other endings, links that lead nowhere, folders
/// with models that models.recursive would read) is counted in a warning. Every problem is a
/// finding: neither or both keys given, nothing found, no such file, one name twice, a name that a
/// manifest cannot hold (control characters, a backslash, not UTF-8).
std::vector<ModelFile> find_models(Settings& settings);
/// Those of distractors.dir, which must be a folder, likewise.
std::vector<ModelFile> find_distractors(Settings& settings);
/// Material files: materials.files, or the .mat files of materials.dir; none of models' own.
std::vector<std::filesystem::path> find_materials(Settings& settings);
/// Environment folders: environments.files, or the folders of environments.dir that hold an
/// environment.scn.
std::vector<std::filesystem::path> find_environments(Settings& settings);

}  // namespace ds

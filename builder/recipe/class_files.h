// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"
#include "manifests/classification.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// Whether the path asks for a models.dir that the recipe does not use.
bool is_of_absent_folder(const Settings& settings, const RecipeValue& path);
/// The file that a class key, or an element of its list, names; {models.dir} in it stands for
/// models.dir. Nothing, with a finding, where there is none.
std::optional<std::filesystem::path> find_class_file(const Settings& settings,
                                                     const RecipeValue& path,
                                                     const std::string& key);
/// Of a .csv file (parse_class_table), or of a .cla file, without splits. Throws Error(asset), all
/// findings.
std::vector<LabelledModel> read_class_list(const std::filesystem::path& file);
/// Adds a parser's findings, which carry their own places, to the recipe's.
void add_findings(const Error& error, Diagnostics& diagnostics);

/// What the classification of a class file is called: its name less ending and "Train" or "Test" behind
/// it, or then its folder's.
std::string hierarchy_name(const std::filesystem::path& file);
/// "train" or "test" as its name ends, or "".
std::string_view split_of_class_file(const std::filesystem::path& file);
/// classes.more: by hierarchy_name; coarse1Train.cla and coarse1/test.cla are of "coarse1". Every
/// problem is a finding.
void read_hierarchies(const Settings& settings, Recipe& recipe);
/// classes.ids: class paths, one a line; empty lines and those that begin with # are not read. Every
/// problem is a finding.
void read_class_ids(const Settings& settings, Recipe& recipe);

}  // namespace ds

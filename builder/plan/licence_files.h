// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/recipe.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ds {

/// Assets (files or folders) by what the manifest calls them.
using NamedAssets = std::vector<std::pair<std::string, std::filesystem::path>>;

/// The licence texts found beside assets, one folder up or in an asset that is a folder, as UTF-8, by
/// "KIND/NAME": all files of the nearest of these folders that is_licence_name knows, and of a folder LICENSES
/// there. Nothing for an asset without one. A licence that cannot be read, has no words, or is
/// larger than licences are, is a warning and none: it costs nobody a dataset.
std::vector<std::pair<std::string, std::string>> licences_beside(const std::string& kind,
                                                                 const NamedAssets& assets);
/// Likewise of the texts that say where assets come from: is_source_name.
std::vector<std::pair<std::string, std::string>> sources_beside(const std::string& kind,
                                                                const NamedAssets& assets);
/// By kind: "models", "materials", "environments".
std::vector<std::pair<std::string, NamedAssets>> licensed_assets(const Recipe& recipe);
/// Throws Error(recipe) where dataset.unlicensed = "error" and an asset has no licence, or
/// dataset.unsourced = "error" and one has no source.
void check_licensed(const Recipe& recipe);

}  // namespace ds

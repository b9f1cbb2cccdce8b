// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ds {

/// The licence texts found beside assets (files or folders), one folder up or in an asset
/// that is a folder, as UTF-8, by "KIND/NAME"; `assets` are their names and paths. Nothing for an asset without one. A licence that cannot be read, or is larger than
/// licences are, is a warning and none: it costs nobody a dataset.
std::vector<std::pair<std::string, std::string>> licences_beside(
    const std::string& kind,
    const std::vector<std::pair<std::string, std::filesystem::path>>& assets);

}  // namespace ds

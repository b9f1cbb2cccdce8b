// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/licence_files.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/utf8.h"

#include <cstdint>
#include <map>
#include <optional>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Names a licence of a folder's files may have.
constexpr const char* k_names[] = {"LICENSE", "LICENCE", "LICENSE.txt", "LICENCE.txt", "COPYING"};
/// The kind of asset that is a folder.
constexpr std::string_view k_environments = "environments";
/// The longest licences in use have 50 kB.
constexpr std::uintmax_t k_most_bytes = 1U << 20U;

std::optional<std::string> read_licence(const fs::path& file) {
  try {
    const std::uintmax_t size = fs::file_size(file);
    if (size <= k_most_bytes) return utf8_of(read_text_file(file));
    warn(fmt::format("{}: {} bytes are no licence; the manifest goes without it", file.string(),
                     size));
  } catch (const std::exception& error) {
    warn(fmt::format("the manifest goes without a licence: {}", error.what()));
  }
  return std::nullopt;
}

/// Beside the asset or one folder up; an asset that is a folder may hold its own.
std::optional<std::string> licence_near(const fs::path& folder, bool is_asset) {
  std::error_code error;
  std::vector<fs::path> places{folder, folder.parent_path()};
  if (is_asset) places.push_back(places.back().parent_path());
  for (const fs::path& place : places)
    for (const char* name : k_names)
      if (fs::is_regular_file(place / name, error)) return read_licence(place / name);
  return std::nullopt;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> licences_beside(
    const std::string& kind, const std::vector<std::pair<std::string, fs::path>>& assets) {
  // One look a folder: there may be thousands of models.
  std::map<fs::path, std::optional<std::string>> known;
  std::vector<std::pair<std::string, std::string>> licences;
  const bool is_folder = kind == k_environments;
  for (const auto& [name, asset] : assets) {
    const fs::path folder = is_folder ? asset : asset.parent_path();
    const auto [entry, is_new] = known.try_emplace(folder);
    if (is_new) entry->second = licence_near(folder, is_folder);
    if (entry->second) licences.emplace_back(fmt::format("{}/{}", kind, name), *entry->second);
  }
  return licences;
}

}  // namespace ds

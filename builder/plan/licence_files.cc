// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/licence_files.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/utf8.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

using Texts = std::vector<std::pair<std::string, std::string>>;

/// A kind of text that stands beside assets.
struct AssetText {
  const char* what;  ///< "licence"
  std::vector<const char*> names;
};
const AssetText& licence_kind() {
  static const AssetText kind{"licence",
                              {"LICENSE", "LICENCE", "LICENSE.txt", "LICENCE.txt", "COPYING"}};
  return kind;
}
const AssetText& source_kind() {
  static const AssetText kind{"source", {"SOURCE", "SOURCE.txt"}};
  return kind;
}

/// The kind of asset that is a folder.
constexpr std::string_view k_environments = "environments";
/// The longest licences in use have 50 kB.
constexpr std::uintmax_t k_most_bytes = 1U << 20U;

std::optional<std::string> read_text(const AssetText& kind, const fs::path& file) {
  try {
    const std::uintmax_t size = fs::file_size(file);
    if (size <= k_most_bytes) return utf8_of(read_text_file(file));
    warn(fmt::format("{}: {} bytes are no {}; the manifest goes without it", file.string(), size,
                     kind.what));
  } catch (const std::exception& error) {
    warn(fmt::format("the manifest goes without a {}: {}", kind.what, error.what()));
  }
  return std::nullopt;
}

/// Beside the asset or one folder up; an asset that is a folder may hold its own.
std::optional<std::string> text_near(const AssetText& kind, const fs::path& folder, bool is_asset) {
  std::error_code error;
  std::vector<fs::path> places{folder, folder.parent_path()};
  if (is_asset) places.push_back(places.back().parent_path());
  for (const fs::path& place : places)
    for (const char* name : kind.names)
      if (fs::is_regular_file(place / name, error)) return read_text(kind, place / name);
  return std::nullopt;
}

Texts texts_beside(const AssetText& text, const std::string& kind, const NamedAssets& assets) {
  // One look a folder: there may be thousands of models.
  std::map<fs::path, std::optional<std::string>> known;
  Texts texts;
  const bool is_folder = kind == k_environments;
  for (const auto& [name, asset] : assets) {
    const fs::path folder = is_folder ? asset : asset.parent_path();
    const auto [entry, is_new] = known.try_emplace(folder);
    if (is_new) entry->second = text_near(text, folder, is_folder);
    if (entry->second) texts.emplace_back(fmt::format("{}/{}", kind, name), *entry->second);
  }
  return texts;
}

void require(const AssetText& text, std::string_view key, const Recipe& recipe) {
  constexpr std::size_t k_shown = 3;
  std::vector<std::string> without;
  for (const auto& [kind, assets] : licensed_assets(recipe)) {
    std::set<std::string> having;
    for (const auto& [name, found] : texts_beside(text, kind, assets))
      having.insert(name);
    for (const auto& [name, asset] : assets)
      if (std::string whole = fmt::format("{}/{}", kind, name); !having.contains(whole))
        without.push_back(std::move(whole));
  }
  if (without.empty()) return;
  const auto shown =
      without.begin() + static_cast<std::ptrdiff_t>(std::min(without.size(), k_shown));
  fail(ErrorKind::recipe,
       "{}: {} = \"error\" wants a {} beside every asset, found none for {}{}: "
       "put a {} file into their folder or the one above",
       recipe.file.string(), key, text.what, fmt::join(without.begin(), shown, ", "),
       without.size() > k_shown ? fmt::format(" and {} more", without.size() - k_shown) : "",
       text.names.front());
}

}  // namespace

std::vector<std::pair<std::string, std::string>> licences_beside(const std::string& kind,
                                                                 const NamedAssets& assets) {
  return texts_beside(licence_kind(), kind, assets);
}

std::vector<std::pair<std::string, std::string>> sources_beside(const std::string& kind,
                                                                const NamedAssets& assets) {
  return texts_beside(source_kind(), kind, assets);
}

std::vector<std::pair<std::string, NamedAssets>> licensed_assets(const Recipe& recipe) {
  const auto named = [](const std::vector<fs::path>& assets) {
    NamedAssets with_names;
    for (const fs::path& asset : assets)
      with_names.emplace_back(asset.filename().string(), asset);
    return with_names;
  };
  NamedAssets models;
  for (const ModelFile& model : recipe.models)
    models.emplace_back(model.name, model.file);
  if (!recipe.distractors.of_recipe)
    for (const DistractorModel& model : recipe.distractors.models)
      models.emplace_back(model.name, model.file);
  return {{"models", std::move(models)},
          {"materials", named(recipe.materials)},
          {k_environments.data(), named(recipe.environments)}};
}

void check_licensed(const Recipe& recipe) {
  if (recipe.refuses_unlicensed) require(licence_kind(), "dataset.unlicensed", recipe);
  if (recipe.refuses_unsourced) require(source_kind(), "dataset.unsourced", recipe);
}

}  // namespace ds

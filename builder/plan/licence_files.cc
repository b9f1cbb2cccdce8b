// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/licence_files.h"

#include "manifests/licences.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/utf8.h"

#include <algorithm>
#include <cctype>
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
  const char* name;  ///< the most usual of its files' names
  bool (*is_name)(std::string_view file);
  bool (*is_folder_name)(std::string_view folder);  ///< of such files
};
constexpr AssetText k_licence{"licence", "LICENSE", is_licence_name, is_licence_folder_name};
constexpr AssetText k_source{"source", "SOURCE", is_source_name,
                             [](std::string_view) { return false; }};

/// The kind of asset that is a folder.
constexpr std::string_view k_environments = "environments";
/// The longest licences in use have 50 kB.
constexpr std::uintmax_t k_most_bytes = 1U << 20U;

/// Not empty, not blank or a rule alone, and no binary file.
bool says_something(std::string_view text) {
  return text.find('\0') == text.npos && std::any_of(text.begin(), text.end(), [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return byte >= 0x80 || std::isalnum(byte) != 0;
         });
}

std::optional<std::string> read_text(const AssetText& kind, const fs::path& file) {
  try {
    const std::uintmax_t size = fs::file_size(file);
    if (size <= k_most_bytes) {
      std::string text = utf8_of(read_text_file(file));
      if (says_something(text)) return text;
      warn(fmt::format("{}: holds no words, which is no {}; the manifest goes without it",
                       file.string(), kind.what));
      return std::nullopt;
    }
    warn(fmt::format("{}: {} bytes are no {}; the manifest goes without it", file.string(), size,
                     kind.what));
  } catch (const std::exception& error) {
    warn(fmt::format("the manifest goes without a {}: {}", kind.what, error.what()));
  }
  return std::nullopt;
}

struct FolderTexts {
  bool any = false;  ///< though none may be a text
  std::vector<std::string> texts;
};
/// One look a folder: there may be thousands of models in it, or of folders beside each other.
using KnownFolders = std::map<fs::path, FolderTexts>;

void add_texts(const AssetText& kind, const fs::path& folder, bool all, FolderTexts& found) {
  std::vector<fs::path> files, folders;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (fs::is_regular_file(at->path(), ignored) &&
        (all ? !name.starts_with('.') : kind.is_name(name)))
      files.push_back(at->path());
    else if (!all && kind.is_folder_name(name) && fs::is_directory(at->path(), ignored))
      folders.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  found.any = found.any || !files.empty();
  for (const fs::path& file : files)
    if (std::optional<std::string> text = read_text(kind, file))
      found.texts.push_back(*std::move(text));
  for (const fs::path& inside : folders)
    add_texts(kind, inside, true, found);
}

/// Beside the asset or one folder up; an asset that is a folder may hold its own.
std::vector<std::string> texts_near(const AssetText& kind, const fs::path& folder, bool is_asset,
                                    KnownFolders& known) {
  std::vector<fs::path> places{folder, folder.parent_path()};
  if (is_asset) places.push_back(places.back().parent_path());
  for (const fs::path& place : places) {
    const auto [at, is_new] = known.try_emplace(place);
    if (is_new) add_texts(kind, place, false, at->second);
    if (at->second.any) return at->second.texts;
  }
  return {};
}

Texts texts_beside(const AssetText& text, const std::string& kind, const NamedAssets& assets) {
  KnownFolders known;
  Texts texts;
  const bool is_folder = kind == k_environments;
  for (const auto& [name, asset] : assets)
    for (const std::string& found :
         texts_near(text, is_folder ? asset : asset.parent_path(), is_folder, known))
      texts.emplace_back(fmt::format("{}/{}", kind, name), found);
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
       text.name);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> licences_beside(const std::string& kind,
                                                                 const NamedAssets& assets) {
  return texts_beside(k_licence, kind, assets);
}

std::vector<std::pair<std::string, std::string>> sources_beside(const std::string& kind,
                                                                const NamedAssets& assets) {
  return texts_beside(k_source, kind, assets);
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
  if (recipe.refuses_unlicensed) require(k_licence, "dataset.unlicensed", recipe);
  if (recipe.refuses_unsourced) require(k_source, "dataset.unsourced", recipe);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/import/init_text.h"

#include "builder/recipe/keys.h"
#include "builder/recipe/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace ds {
namespace {

constexpr std::size_t k_width = 100;

/// Lines of comment, broken at spaces.
std::string comment(const std::string& text) {
  std::string lines, line = "#";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (line.size() + 1 + end - at > k_width && line.size() > 1) {
      lines += line + "\n";
      line = "#";
    }
    line += " " + text.substr(at, end - at);
    at = end + 1;
  }
  return lines + line + "\n";
}

std::string without_marks(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
  return text;
}

std::string key_text(const KeySpec& key, const std::map<std::string_view, std::string>& given) {
  const std::string_view name = key.name.substr(key.name.find('.') + 1);
  std::string meaning = wanted_text(key);
  if (!key.unit.empty()) meaning += fmt::format(" ({})", key.unit);
  meaning += ": " + help_of(key);
  if (!key.only_with.empty()) meaning += fmt::format(". Only with {}", key.only_with);
  const std::string text = comment(without_marks(std::move(meaning)));
  if (const auto at = given.find(key.name); at != given.end())
    return fmt::format("{}{} = {}\n", text, name, at->second);
  return key.has_default() ? fmt::format("{}#{} = {}\n", text, name, key.default_value)
                           : fmt::format("{}#{} =\n", text, name);
}

}  // namespace

std::string commented_recipe(const std::string& name, const std::filesystem::path& models,
                             const std::filesystem::path& assets) {
  const std::map<std::string_view, std::string> given{
      {"dataset.name", to_toml(name)},
      {"models.dir", to_toml(models.string())},
      {"materials.dir", to_toml((assets / "materials").string())},
      {"materials.assign", "\"random\""},
      {"environments.dir", to_toml((assets / "environments").string())},
      {"environments.assign", "\"cycle\""},
      {"camera.set", "\"half-dodecahedron\""},
      {"camera.distance_m", "\"fit\""},
      {"engine.width", "256"},
      {"engine.height", "256"},
      {"outputs.mask", "true"}};
  std::string text =
      "# Made by dsbuild init. Lines that begin with # are left out: each key stands behind its "
      "meaning,\n"
      "# with its default. See one view first, and whether the models stand upright (models.up):\n"
      "#   dsbuild build RECIPE -o preview --set 'camera.views=[1]' --set engine.spp=16\n";
  std::string_view section;
  for (const KeySpec& key : recipe_keys()) {
    if (key.type == KeyType::lights) {
      section = key.name;
      text += "\n" + comment(std::string(key.help)) + "#[[lights]]\n#type = \"point\"\n" +
              "#position_m = { shell = [0.5, 1], elevation_deg = [20, 80] }\n#gain = 5\n";
      continue;
    }
    if (const std::string_view own = key.name.substr(0, key.name.find('.')); own != section) {
      section = own;
      text += fmt::format("\n[{}]\n", section);
    }
    text += key_text(key, given);
  }
  return text;
}

}  // namespace ds

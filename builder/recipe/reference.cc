// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/keys.h"
#include "builder/recipe/lights.h"
#include "builder/recipe/planes.h"
#include "builder/recipe/variables.h"
#include "manifests/classification.h"
#include "tracer/scene/mesh_formats.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace ds {
namespace {

std::string_view type_text(KeyType type) {
  switch (type) {
    case KeyType::text:
      return "a string";
    case KeyType::name:
      return "a string of letters, digits and . _ - that starts with no dot";
    case KeyType::path:
      return "a path (a string)";
    case KeyType::path_list:
      return "a list of paths (strings)";
    case KeyType::text_list:
      return "a list of strings";
    case KeyType::choice:
      return "";
    case KeyType::boolean:
      return "true or false";
    case KeyType::integer:
      return "an integer";
    case KeyType::integer_list:
      return "a list of integers >= 0";
    case KeyType::number:
      return "a number";
    case KeyType::point:
      return "a list of three numbers";
    case KeyType::quaternion:
      return "a list of four numbers";
    case KeyType::point_list:
      return "a list of lists of three numbers";
    case KeyType::lights:
      return "a list of tables";
    case KeyType::patterns:
      return "a table of patterns, each = a number, a list of three, or a distribution";
  }
  return "";
}

std::string_view moves_text(Moves moves) {
  switch (moves) {
    case Moves::images:
      return "which images";
    case Moves::scene:
      return "pictures, masks, depths";
    case Moves::film:
      return "pictures";
    case Moves::files:
      return "files";
    case Moves::manifest:
      return "manifest";
  }
  return "";
}

std::string replace_all(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Literals in Markdown: each in code, "or" between.
std::string literals(std::string_view choices) {
  return choices.empty() ? "" : "`" + replace_all(std::string(choices), " | ", "` or `") + "`";
}

std::string type_cell(const KeySpec& key) {
  std::string cell(key.type == KeyType::choice ? literals(key.choices) : type_text(key.type));
  if (const std::string range = key.range.text(); !range.empty()) cell += " " + range;
  if (key.type != KeyType::choice && !key.choices.empty()) cell += " or " + literals(key.choices);
  if (find_variable(key.name) != nullptr) cell += " or a distribution";
  return cell;
}

std::string default_cell(const KeySpec& key) {
  if (key.default_value.empty()) return "none";
  if (key.has_default()) return "`" + std::string(key.default_value) + "`";
  return std::string(key.default_value.substr(1, key.default_value.size() - 2));
}

std::string distribution_reference() {
  std::string text =
      "| word | of | wants | beside it | what it gives |\n| --- | --- | --- | --- | --- |\n";
  for (const DistributionWord& word : distribution_words()) {
    std::string kinds, beside;
    for (const DrawnKind kind : word.kinds)
      kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", name_of(kind));
    for (const std::string_view name : word.beside)
      beside += fmt::format("{}`{}`{}", beside.empty() ? "" : ", ", name.substr(0, name.find('!')),
                            name.ends_with('!') ? " (must)" : "");
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", word.name, kinds, shape_text(word.shape),
                        beside, word.help);
  }
  return text;
}

std::string help_cell(const KeySpec& key) {
  std::string cell = help_of(key);
  if (!key.only_with.empty()) {
    const KeyCondition condition = condition_of(key);
    cell += fmt::format(". Only with `{}` {} {}", condition.key,
                        condition.wanted ? "=" : "!=", literals(condition.literals));
  }
  return cell;
}

}  // namespace

std::string help_of(const KeySpec& key) {
  const std::string help =
      replace_all(std::string(key.help), "{mesh endings}", mesh_endings_text(" and "));
  return replace_all(help, "{split names}", split_names_text());
}

std::string wanted_text(const KeySpec& key) {
  std::string wanted(type_text(key.type));
  if (const std::string range = key.range.text(); !range.empty()) wanted += " " + range;
  const std::string choices = replace_all(std::string(key.choices), " | ", " or ");
  if (!wanted.empty() && !choices.empty()) wanted += " or ";
  return wanted + choices;
}

std::string recipe_reference() {
  std::string text;
  std::string_view section;
  for (const KeySpec& key : recipe_keys()) {
    const std::string_view own = key.name.substr(0, key.name.find('.'));
    if (key.type == KeyType::lights) {
      section = own;
      text += fmt::format(
          "\n### [[{}]]\n\n{}. They move pictures, and with `camera.keep.clearance_m` views.\n\n{}",
          own, key.help, light_reference());
      continue;
    }
    if (own != section) {
      section = own;
      text += fmt::format(
          "{}### [{}]\n\n| key | type and range | unit | default | what it does | moves |\n"
          "| --- | --- | --- | --- | --- | --- |\n",
          text.empty() ? "" : "\n", section);
    }
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.name.substr(own.size() + 1),
                        type_cell(key), key.unit, default_cell(key), help_cell(key),
                        moves_text(key.moves));
  }
  return text + "\n### Words of distributions\n\n" + distribution_reference() +
         "\n### Mesh formats\n\n" + mesh_format_reference() + "\n### Planes\n\n" +
         plane_reference();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/settings.h"

#include "builder/recipe/planes.h"
#include "builder/recipe/variables.h"
#include "tracer/base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

bool is_name(std::string_view text) {
  constexpr std::string_view k_allowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  return !text.empty() && text.front() != '.' && text.find_first_not_of(k_allowed) == text.npos;
}

bool is_list_of(std::size_t count, const KeySpec& key, const RecipeValue& value) {
  const auto* list = value.array();
  return list != nullptr && list->size() == count &&
         std::all_of(list->begin(), list->end(), [&](const RecipeValue& v) {
           return v.is_number() && key.range.contains(v.number());
         });
}

/// The part of `value` that is not as its key wants: an element of a list, or itself; nullptr where
/// all is well.
template <typename Fits>
const RecipeValue* first_unfit(const RecipeValue& value, Fits fits) {
  if (value.array() == nullptr) return &value;
  for (const RecipeValue& element : *value.array()) {
    if (!fits(element)) return &element;
  }
  return nullptr;
}

const RecipeValue* unfit_part(const KeySpec& key, const RecipeValue& value) {
  if (is_choice(key.choices, to_toml(value))) return nullptr;
  const auto all_or_nothing = [&](bool fits) { return fits ? nullptr : &value; };
  switch (key.type) {
    case KeyType::text:
    case KeyType::path:
      return all_or_nothing(value.text() != nullptr);
    case KeyType::name:
      return all_or_nothing(value.text() != nullptr && is_name(*value.text()));
    case KeyType::choice:
      return &value;
    case KeyType::boolean:
      return all_or_nothing(value.boolean() != nullptr);
    case KeyType::integer:
      return all_or_nothing(value.integer() != nullptr && key.range.contains(value.number()));
    case KeyType::number:
      return all_or_nothing(value.is_number() && key.range.contains(value.number()));
    case KeyType::path_list:
    case KeyType::text_list:
      return first_unfit(
          value, [](const RecipeValue& v) { return v.text() != nullptr && !v.text()->empty(); });
    case KeyType::integer_list:
      return first_unfit(
          value, [](const RecipeValue& v) { return v.integer() != nullptr && *v.integer() >= 0; });
    case KeyType::point:
      return all_or_nothing(is_list_of(3, key, value));
    case KeyType::quaternion:
      return all_or_nothing(
          is_list_of(4, key, value) &&
          std::any_of(value.array()->begin(), value.array()->end(),
                      [](const RecipeValue& number) { return number.number() != 0; }));
    case KeyType::point_list:
      return first_unfit(value, [&](const RecipeValue& v) { return is_list_of(3, key, v); });
    case KeyType::patterns:
      return all_or_nothing(value.table() != nullptr);
    case KeyType::lights:
      return first_unfit(value, [](const RecipeValue& v) { return v.table() != nullptr; });
  }
  return &value;
}

std::string found_text(const RecipeValue& value) {
  std::string text = to_toml(value);
  return text.size() <= 80 ? text : text.substr(0, 77) + "...";
}

/// "" and [] mean no path, so that --set can take one away.
bool is_no_path(const KeySpec& key, const RecipeValue& value) {
  return (key.type == KeyType::path && value.text() != nullptr && value.text()->empty()) ||
         (key.type == KeyType::path_list && value.array() != nullptr && value.array()->empty());
}

/// ", did you mean "orbit"?": of a key's literals.
std::string choice_meant(const KeySpec& key, const RecipeValue& value) {
  if (value.text() == nullptr) return "";
  std::vector<std::string_view> literals;
  for (std::string_view rest = key.choices; !rest.empty();) {
    const std::size_t end = rest.find(" | ");
    literals.push_back(rest.substr(0, end));
    rest.remove_prefix(end == rest.npos ? rest.size() : end + 3);
  }
  return did_you_mean(to_toml(value), literals);
}

bool is_list_of_tables(const RecipeValue& value) {
  const RecipeValue::Array* list = value.array();
  return list != nullptr && !list->empty() &&
         std::all_of(list->begin(), list->end(),
                     [](const RecipeValue& one) { return one.table() != nullptr; });
}

/// "; [[lights]] begins each": where TOML's one bracket or two make a table of what is a list, or the other way
/// round.
std::string list_meant(const KeySpec& key, const RecipeValue& value) {
  if (key.type == KeyType::lights && value.table() != nullptr)
    return fmt::format("; each begins with [[{0}]], two brackets, of which [{0}] makes no list",
                       key.name);
  if (key.type == KeyType::patterns && is_list_of_tables(value))
    return fmt::format("; it is [{0}], not [[{0}]]", key.name);
  return "";
}

/// Whether a key of another section is worth naming, which takes such a value: classes.train is a path, and so
/// not what a share is for.
bool may_mean(std::string_view unknown, std::string_view meant, const RecipeValue& value) {
  const auto section_of = [](std::string_view name) { return name.substr(0, name.rfind('.')); };
  return section_of(unknown) == section_of(meant) || fits(*find_key(meant), value) ||
         (find_variable(meant) != nullptr && is_distribution(value));
}

bool is_section(std::string_view name) {
  const auto keys = recipe_keys();
  return std::any_of(keys.begin(), keys.end(), [&](const KeySpec& key) {
    return key.name.size() > name.size() && key.name.starts_with(name) &&
           key.name[name.size()] == '.';
  });
}

}  // namespace

bool fits(const KeySpec& key, const RecipeValue& value) {
  return unfit_part(key, value) == nullptr;
}

Settings::Settings(const fs::path& file, RecipeValue::Table tree, Diagnostics& diagnostics)
    : file_(file.string()), folder_(fs::absolute(file).parent_path()), diagnostics_(diagnostics) {
  for (const KeySpec& key : recipe_keys()) {
    if (key.has_default()) defaults_.emplace(key.name, parse_value(key.default_value));
  }
  std::vector<std::pair<std::string, RecipeValue>> found;
  collect("", tree, found);
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    const auto order = [](const RecipeValue& v) {
      return std::tuple(v.from_set, v.place.line, v.place.column);
    };
    return order(a.second) < order(b.second);
  });
  for (auto& [name, value] : found)
    check(name, std::move(value));
  check_effects();
}

/// Flattens the tree to keys of the table and to what is none.
void Settings::collect(const std::string& prefix, RecipeValue::Table& table,
                       std::vector<std::pair<std::string, RecipeValue>>& found) {
  for (auto& [part, value] : table) {
    std::string name = prefix.empty() ? part : fmt::format("{}.{}", prefix, part);
    if (prefix.empty() && value.table() != nullptr && !is_section(name)) {
      const std::string meant = section_meant(name, value);
      // An empty table stands for the section in what is to be checked, to be reported in its place.
      if (meant != name)
        found.emplace_back(name, RecipeValue{RecipeValue::Table{}, value.place, value.from_set});
      if (meant.empty()) continue;
      name = meant;
    }
    // An unknown table too, so that its keys can be compared with known ones; an empty one stays to
    // be reported.
    const bool unknown = find_key(name) == nullptr && !is_section(name);
    if (value.table() != nullptr && (is_section(name) || (unknown && !value.table()->empty()))) {
      collect(name, *value.table(), found);
    } else {
      found.emplace_back(name, std::move(value));
    }
  }
}

void Settings::check(const std::string& name, RecipeValue value) {
  const KeySpec* key = find_key(name);
  if (key == nullptr) {
    if (is_section(name)) {
      const bool is_list = is_list_of_tables(value);
      complain(
          value, name,
          fmt::format("must be {}a table of keys, got {}{}", is_list ? "one [" + name + "], " : "",
                      found_text(value), is_list ? ", as [[" + name + "]] makes it" : ""));
      return;
    }
    complain_of_unknown(name, value);
    return;
  }
  if (const VariableKey* row = find_variable(name); row != nullptr && is_distribution(value)) {
    auto distribution = read_distribution(
        value, row->kind, key->range,
        [&](const RecipeValue& at, const std::string& message) { complain(at, name, message); });
    if (distribution && !distribution->word->by_view && !value.table()->contains("per"))
      distribution->per = row->per;
    (distribution ? values_ : wrong_).emplace(name, std::move(value));
    if (distribution) distributions_.emplace(name, *std::move(distribution));
    return;
  }
  if (const RecipeValue* unfit = unfit_part(*key, value)) {
    const std::string plane = plane_meant(name, *unfit);
    complain(*unfit, name,
             fmt::format("must be {}, got {}{}{}{}", wanted_text(*key), found_text(*unfit),
                         plane.empty() ? choice_meant(*key, *unfit) : plane,
                         is_distribution(value) ? "; it takes no distribution" : "",
                         list_meant(*key, *unfit)));
    wrong_.emplace(name, std::move(value));
    return;
  }
  if (!is_no_path(*key, value)) values_.emplace(name, std::move(value));
}

void Settings::complain_of_unknown(const std::string& name, const RecipeValue& value) {
  if (value.table() != nullptr && name.find('.') == name.npos) {
    complain(value, name, "is no section of a recipe" + known_words(name, recipe_sections()));
    return;
  }
  std::string help = plane_meant(name, value);
  if (!help.empty()) {
    complain(value, name, "is no key of a recipe" + help);
    return;
  }
  if (const std::string_view meant = nearest_key(name);
      !meant.empty() && may_mean(name, meant, value)) {
    meant_.emplace(meant);
    help = fmt::format(", did you mean {}?", meant);
  } else {
    const std::string section = name.substr(0, name.find('.'));
    std::vector<std::string_view> keys;
    for (const KeySpec& key : recipe_keys())
      if (key.name.starts_with(section + ".")) keys.push_back(key.name.substr(section.size() + 1));
    if (!keys.empty()) help = fmt::format("; {} has {}", section, fmt::join(keys, ", "));
  }
  complain(value, name, "is no key of a recipe" + help);
}

/// The section that one which is none was most likely meant to be, and as whose its keys are read;
/// itself where its keys tell where they belong, "" where nothing does.
std::string Settings::section_meant(const std::string& name, const RecipeValue& table) {
  const std::vector<std::string_view> sections = recipe_sections();
  const std::string_view meant = nearest(name, sections);
  const auto known_key = [&](const auto& key) {
    return !nearest_key(name + "." + key.first).empty();
  };
  const RecipeValue::Table& keys = *table.table();
  // [lens] fov_deg = 40: each key says where it belongs.
  if (meant.empty() && std::any_of(keys.begin(), keys.end(), known_key)) return name;
  return std::string(meant);
}

/// A key that nothing will look at is an error, unless --set has just chosen something else than
/// the recipe did.
void Settings::check_effects() {
  std::vector<std::string_view> idle;
  for (const KeySpec& key : recipe_keys()) {
    const auto value = values_.find(key.name);
    if (value == values_.end() || applies(key)) continue;
    const std::string_view chooser = condition_of(key).key;
    if (wrong_.contains(chooser) || misspelt(chooser)) continue;
    if (value->second.from_set || !given_by_set(chooser)) {
      complain(value->second, key.name,
               fmt::format("has no effect with {} = {}, only with {}", chooser, literal(chooser),
                           key.only_with));
      misfits_.emplace(chooser);
    }
    idle.push_back(key.name);
  }
  for (const std::string_view key : idle)
    unset(key);
}

bool Settings::applies(const KeySpec& key) const {
  if (key.only_with.empty()) return true;
  const KeyCondition condition = condition_of(key);
  return is_choice(condition.literals, literal(condition.key)) == condition.wanted;
}

bool Settings::given_by_set(std::string_view key) const {
  const auto right = values_.find(key);
  const auto wrong = wrong_.find(key);
  return (right != values_.end() && right->second.from_set) ||
         (wrong != wrong_.end() && wrong->second.from_set);
}

const RecipeValue* Settings::find(std::string_view key) const {
  DS_ASSERT(find_key(key) != nullptr);
  if (const auto at = values_.find(key); at != values_.end()) return &at->second;
  const auto at = defaults_.find(key);
  return at == defaults_.end() ? nullptr : &at->second;
}

const Distribution* Settings::distribution(std::string_view key) const {
  const auto at = distributions_.find(key);
  return at == distributions_.end() ? nullptr : &at->second;
}

void Settings::unset(std::string_view key) {
  if (const auto at = distributions_.find(key); at != distributions_.end())
    distributions_.erase(at);
  if (const auto at = values_.find(key); at != values_.end()) values_.erase(at);
  if (const auto at = wrong_.find(key); at != wrong_.end()) wrong_.erase(at);
}

const std::string& Settings::text(std::string_view key) const {
  const RecipeValue* value = find(key);
  DS_ASSERT(value != nullptr && value->text() != nullptr);
  return *value->text();
}

double Settings::number(std::string_view key) const {
  const RecipeValue* value = find(key);
  DS_ASSERT(value != nullptr && value->is_number());
  return value->number();
}

int Settings::integer(std::string_view key) const {
  const RecipeValue* value = find(key);
  DS_ASSERT(value != nullptr && value->integer() != nullptr);
  return static_cast<int>(*value->integer());
}

bool Settings::boolean(std::string_view key) const {
  const RecipeValue* value = find(key);
  DS_ASSERT(value != nullptr && value->boolean() != nullptr);
  return *value->boolean();
}

std::string Settings::literal(std::string_view key) const {
  const RecipeValue* value = find(key);
  DS_ASSERT(value != nullptr);
  return to_toml(*value);
}

fs::path Settings::resolve(const RecipeValue& giver, const std::string& path) const {
  const fs::path base = giver.from_set ? fs::current_path() : folder_;
  const fs::path resolved = (base / path).lexically_normal();
  return resolved.has_filename() ? resolved : resolved.parent_path();
}

void Settings::complain(const RecipeValue& value, std::string_view key,
                        std::string_view message) const {
  // "--set camera.fov_deg" names the key already.
  const bool named = value.from_set && value.place.file.ends_with(" " + std::string(key));
  if (named) {
    diagnostics_.add(value.place, "{}", message);
  } else {
    diagnostics_.add(value.place, "{} {}", key, message);
  }
}

void Settings::complain(std::string_view key, std::string_view message) const {
  for (const auto* values : {&values_, &wrong_}) {
    if (const auto at = values->find(key); at != values->end())
      return complain(at->second, key, message);
  }
  if (misspelt(key)) return;
  diagnostics_.add({file_, 0, 0}, "{} {}", key, message);
}

}  // namespace ds

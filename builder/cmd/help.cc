// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/help_text.h"
#include "builder/cmd/verbs.h"
#include "builder/recipe/keys.h"
#include "builder/recipe/lights.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"
#include "tracer/scene/sdl_parameters.h"

#include <algorithm>
#include <iterator>

namespace ds {
namespace {

/// For a terminal: no code marks.
std::string plain(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
  return text;
}

std::string parameters_text(std::string_view title, const std::vector<SdlParameter>& parameters) {
  std::vector<HelpRow> rows;
  for (const SdlParameter& p : parameters) {
    std::string help = wanted_text(p);
    if (!p.default_value.empty()) help += fmt::format(" [{}]", p.default_value);
    if (!p.help.empty()) help += ": " + p.help;
    rows.push_back({p.name, plain(std::move(help))});
  }
  return help_rows(title, rows);
}

std::string type_text(const SdlSection& section, const SdlTypeRow& row) {
  std::string text;
  if (!row.name.empty())
    text = wrap(plain(fmt::format("{}.NAME.type = {}: {}", section_of(section.kind), row.name,
                                  row.help))) +
           "\n";
  return text + parameters_text("Properties", row.parameters);
}

std::string section_text(const SdlSection& section, const std::string& name) {
  const SdlTypeRow* row = name.empty() ? nullptr : find_type(section, name);
  if (!name.empty() && row == nullptr)
    fail(ErrorKind::usage, "help: {} is no type of {}{}", name, section.topic,
         known_words(name, type_names(section)));
  std::string text;
  if (row == nullptr)
    text = wrap(plain(fmt::format("{}: {}", section_of(section.kind), section.help))) + "\n";
  if (row == nullptr && !section.default_type.empty())
    text += fmt::format("Without a type it is {}.\n", section.default_type);
  for (const SdlTypeRow& one : section.types)
    if (row == nullptr || row == &one) text += (text.empty() ? "" : "\n") + type_text(section, one);
  if (!section.common.empty()) text += "\n" + parameters_text("Every type has", section.common);
  return text;
}

std::string key_text(const KeySpec& key) {
  std::string help = wanted_text(key);
  if (!key.unit.empty()) help += fmt::format(" ({})", key.unit);
  if (!key.default_value.empty()) help += fmt::format(" [{}]", key.default_value);
  help += ": " + help_of(key);
  if (!key.only_with.empty()) help += fmt::format(". Only with {}", key.only_with);
  return help;
}

/// Of [[lights]], whose keys are of their types.
std::string lights_text(const KeySpec& key) {
  std::vector<HelpRow> rows;
  for (const LightKeyRow& row : light_key_rows()) {
    std::string help = fmt::format("({}) {}", row.types, wanted_text(row.key));
    if (!row.key.unit.empty()) help += fmt::format(" ({})", row.key.unit);
    if (!row.key.default_value.empty()) help += fmt::format(" [{}]", row.key.default_value);
    rows.push_back({row.key.name, plain(help + ": " + row.key.help)});
  }
  return wrap(fmt::format("[[{}]]: {}", key.name, key.help)) + "\n" +
         help_rows("type, name, count and", rows);
}

/// All keys, those of a section ("camera"), or one ("camera.fov_deg").
std::string recipe_text(const std::string& name) {
  std::vector<HelpRow> rows;
  std::string section, text;
  std::vector<std::string_view> names;
  const auto close = [&] {
    if (!rows.empty()) text += (text.empty() ? "" : "\n") + help_rows("[" + section + "]", rows);
    rows.clear();
  };
  for (const KeySpec& key : recipe_keys()) {
    const std::string own(key.name.substr(0, key.name.find('.')));
    if (names.empty() || own != section) names.emplace_back(key.name.substr(0, own.size()));
    names.push_back(key.name);
    if (own != section) close();
    section = own;
    if (name.empty() || name == own || name == key.name) {
      if (key.type == KeyType::lights) {
        text += (text.empty() ? "" : "\n") + lights_text(key);
        continue;
      }
      rows.push_back({std::string(key.name.substr(own.size() + 1)), key_text(key)});
    }
  }
  close();
  if (!text.empty()) return text;
  const std::string_view meant = nearest(name, names);
  const std::string_view key = meant.empty() ? nearest_key(name) : meant;
  fail(ErrorKind::usage, "help: {} is no key or section of a recipe{}", name,
       key.empty() ? "; dsbuild help recipe lists them" : fmt::format(", did you mean {}?", key));
}

constexpr std::string_view k_recipe = "recipe";

const SdlSection* find_topic(std::string_view topic) {
  for (const SdlSection* section : sdl_sections())
    if (section->topic == topic) return section;
  return nullptr;
}

bool is_verb(std::string_view name) {
  return std::any_of(verbs().begin(), verbs().end(),
                     [&](const Verb& verb) { return verb.name == name; });
}

/// Of a topic that is a section of scene files, and may be one of a recipe too.
std::string scene_topic_text(const SdlSection& section, const std::string& name) {
  const std::string topic(section.topic);
  if (!is_recipe_section(topic)) return section_text(section, name);
  if (!name.empty() && find_type(section, name) == nullptr &&
      find_key(topic + "." + name) != nullptr)
    return recipe_text(topic + "." + name);
  std::string text = section_text(section, name);
  return name.empty() ? text + "\n" + recipe_section_hint(topic) : text;
}

/// Of all sections that have a type of that name ("mix" is a material and a texture).
std::string type_topic_text(const std::string& type) {
  std::string text;
  for (const SdlSection* section : sdl_sections())
    if (section->types.size() > 1 && find_type(*section, type) != nullptr)
      text += (text.empty() ? "" : "\n") + section_text(*section, type);
  return text;
}

[[noreturn]] void refuse_topic(const std::string& topic) {
  std::vector<std::string_view> words = help_topics();
  for (const Verb& verb : verbs())
    words.emplace_back(verb.name);
  const std::string_view key = nearest(topic, words).empty() ? nearest_key(topic) : "";
  fail(ErrorKind::usage, "help: {} is no verb or topic{}", topic,
       key.empty() ? known_words(topic, words) : fmt::format(", did you mean {}?", key));
}

std::string topic_text(const std::string& topic, const std::string& name) {
  if (topic == k_recipe) return recipe_text(name);
  if (const SdlSection* section = find_topic(topic)) return scene_topic_text(*section, name);
  // "models" is a verb too, whose help names the keys.
  if (is_recipe_section(topic) && !(is_verb(topic) && name.empty()))
    return recipe_text(name.empty() ? topic : topic + "." + name);
  const std::string types = type_topic_text(topic);
  if (!is_verb(topic) && find_key(topic) == nullptr && types.empty()) refuse_topic(topic);
  if (!name.empty())
    fail(ErrorKind::usage, "help {}: does not know what to do with {}", topic, name);
  return is_verb(topic) ? help_of(topic) : types.empty() ? recipe_text(topic) : types;
}

}  // namespace

std::vector<std::string_view> help_topics() {
  std::vector<std::string_view> topics;
  for (const SdlSection* section : sdl_sections())
    topics.push_back(section->topic);
  topics.push_back(k_recipe);
  return topics;
}

bool is_recipe_section(std::string_view name) {
  const std::vector<std::string_view> sections = recipe_sections();
  return std::find(sections.begin(), sections.end(), name) != sections.end();
}

std::string recipe_section_hint(std::string_view name) {
  return is_recipe_section(name)
             ? fmt::format("The keys of a recipe's [{0}]: dsbuild help recipe {0}\n", name)
             : "";
}

std::vector<HelpRow> topic_rows() {
  std::vector<HelpRow> rows{
      {std::string(k_recipe), fmt::format("every key of a recipe; or those of one section: {}",
                                          fmt::join(recipe_sections(), ", "))}};
  for (const SdlSection* section : sdl_sections())
    rows.push_back({std::string(section->topic),
                    fmt::format("{}.* of a scene's files: properties, ranges, defaults",
                                section_of(section->kind))});
  return rows;
}

int run_help(const Arguments& arguments) {
  write_text(Stream::result, arguments.topic.empty()
                                 ? help_of("")
                                 : topic_text(arguments.topic, arguments.topic_name));
  return 0;
}

}  // namespace ds

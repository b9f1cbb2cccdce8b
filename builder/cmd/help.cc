// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/help_text.h"
#include "builder/cmd/verbs.h"
#include "builder/recipe/keys.h"
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
  help += fmt::format(": {}", key.help);
  if (!key.only_with.empty()) help += fmt::format(". Only with {}", key.only_with);
  return help;
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
    if (name.empty() || name == own || name == key.name)
      rows.push_back({std::string(key.name.substr(own.size() + 1)), key_text(key)});
  }
  close();
  if (!text.empty()) return text;
  const std::string_view meant = nearest(name, names);
  const std::string_view key = meant.empty() ? nearest_key(name) : meant;
  fail(ErrorKind::usage, "help: {} is no key or section of a recipe{}", name,
       key.empty() ? "; dsbuild help recipe lists them" : fmt::format(", did you mean {}?", key));
}

constexpr std::string_view k_recipe = "recipe";

std::string topic_text(const std::string& topic, const std::string& name) {
  if (topic == k_recipe) return recipe_text(name);
  for (const SdlSection* section : sdl_sections())
    if (section->topic == topic) return section_text(*section, name);
  std::vector<std::string_view> words = help_topics();
  for (const Verb& verb : verbs())
    words.emplace_back(verb.name);
  if (std::find(words.begin(), words.end(), topic) != words.end()) {
    if (!name.empty())
      fail(ErrorKind::usage, "help {}: does not know what to do with {}", topic, name);
    return help_of(topic);
  }
  fail(ErrorKind::usage, "help: {} is no verb or topic{}", topic, known_words(topic, words));
}

}  // namespace

std::vector<std::string_view> help_topics() {
  std::vector<std::string_view> topics;
  for (const SdlSection* section : sdl_sections())
    topics.push_back(section->topic);
  topics.push_back(k_recipe);
  return topics;
}

int run_help(const Arguments& arguments) {
  write_text(Stream::result, arguments.topic.empty()
                                 ? help_of("")
                                 : topic_text(arguments.topic, arguments.topic_name));
  return 0;
}

}  // namespace ds

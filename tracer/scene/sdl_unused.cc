// SPDX-License-Identifier: Apache-2.0
// What is in a file and nobody took, and what is missed in it: each said once, with what was most
// likely meant.
#include "tracer/base/nearest.h"
#include "tracer/scene/sdl_node.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ds {
namespace {

constexpr SdlKind k_scene_kinds[] = {SdlKind::texture, SdlKind::material, SdlKind::shape,
                                     SdlKind::object, SdlKind::light};

/// Top parts of names that LuxCore has and this file has no place for, and why.
struct Elsewhere {
  std::string_view prefix;
  std::string_view reason;
};
constexpr Elsewhere k_elsewhere[] = {
    {"scene.camera", "does not belong here: the camera is in the recipe"},
    {"scene.volumes", "is not supported yet"},
    {"scene.world", "is not supported yet"},
    {"scene.epsilon", "is not supported yet"},
    {"scene.images", "is not supported yet"},
    {"scene.lightgroups", "is not supported yet"},
    {"scene.sunlight", "is not supported yet: name it scene.lights.NAME.type = sun"},
    {"scene.skylight", "is not supported yet: name it scene.lights.NAME.type = sky2"},
    {"scene.infinitelight", "is not supported yet: name it scene.lights.NAME.type = infinite"},
    {"film.imagepipelines", "is not supported yet: use film.imagepipeline"},
    {"film", "does not belong here: only film.imagepipeline does, the rest is in the recipe"},
    {"renderengine", "does not belong here: the engine is in the recipe"},
    {"sampler", "does not belong here: the engine is in the recipe"},
    {"path", "does not belong here: the engine is in the recipe"},
    {"lightstrategy", "does not belong here: the engine is in the recipe"},
    {"batch", "does not belong here: the engine is in the recipe"},
    {"opencl", "does not belong here: the engine is in the recipe"},
    {"native", "does not belong here: the engine is in the recipe"},
};

bool is_below(std::string_view name, std::string_view prefix) {
  return name.size() > prefix.size() && name.starts_with(prefix) && name[prefix.size()] == '.';
}

/// Types are named by what dsbuild reads; LuxCore's others are told apart.
std::string unknown_type(const SdlSection& section, std::string_view type) {
  const std::string_view word = word_for(section.kind);
  if (luxcore_has_type(section.kind, type))
    return fmt::format("{} type \"{}\" is not supported yet; there are {}", word, type,
                       fmt::join(type_names(section), ", "));
  return fmt::format("{} type \"{}\" is unknown{}", word, type,
                     known_words(type, type_names(section)));
}

std::string_view article(std::string_view word) {
  return std::string_view("aeio").find(word.front()) == std::string_view::npos ? "a" : "an";
}

/// The unknown properties of one thing.
struct UnknownOfNode {
  std::string node;  ///< "body"
  SdlKind kind{};
  std::vector<const Property*> properties;
};

std::string_view behind(const Property& property, SdlKind kind, std::string_view node) {
  return std::string_view(property.name).substr(section_of(kind).size() + node.size() + 2);
}

/// One finding for a misspelt property, and one for all others of a thing: where its type is wrong
/// or missing, they are unknown for one reason.
void report_unknown(SdlReader& reader, const UnknownOfNode& unknown) {
  const SdlSection& section = sdl_section(unknown.kind);
  const std::string prefix = fmt::format("{}.{}", section_of(unknown.kind), unknown.node);
  const Property* type = reader.properties.find(prefix + ".type");
  const std::string type_name =
      type != nullptr ? type->values.front() : std::string(section.default_type);
  const SdlTypeRow* row =
      section.types.size() == 1 ? &section.types.front() : find_type(section, type_name);
  const std::string_view word = word_for(section.kind);
  std::vector<const Property*> others;
  for (const Property* property : unknown.properties) {
    const std::string_view name = behind(*property, unknown.kind, unknown.node);
    if (find_parameter(section, row, name) != nullptr) {
      // Known, and not read: another takes its place, or the thing could not be read that far.
      if (!reader.broken.contains(prefix))
        reader.diagnostics.add(property->place, "{} has no effect beside the {}'s other properties",
                               property->name, word);
      continue;
    }
    const std::string_view meant = meant_property(section, row, name);
    if (meant.empty()) {
      others.push_back(property);
      continue;
    }
    reader.diagnostics.add(property->place, "{} is unknown to {} {}, did you mean {}?",
                           property->name, article(word), word, meant);
    // Without its type the thing was read as one of another: nothing else is to be said of it.
    if (meant == "type") return;
  }
  if (others.empty()) return;
  std::string more;
  for (std::size_t i = 1; i < others.size(); ++i)
    more += fmt::format("{}{}", i == 1 ? " (and " : ", ",
                        behind(*others[i], unknown.kind, unknown.node));
  std::string of_type;
  if (section.types.size() > 1)
    of_type = type != nullptr ? fmt::format(" of type {}", type_name)
                              : fmt::format(" of type {}, which it is without a type", type_name);
  std::vector<std::string_view> names = parameter_names(section, row);
  std::erase_if(names, [](std::string_view n) { return n.find('.') != std::string_view::npos; });
  reader.diagnostics.add(others.front()->place, "{}{} is unknown to {} {}{}{}",
                         others.front()->name, more.empty() ? "" : more + ")", article(word), word,
                         of_type,
                         names.empty() ? "" : fmt::format("; it has {}", fmt::join(names, ", ")));
}

/// What belongs to a thing of the section; false for a property that is unknown to it.
bool report_known(SdlReader& reader, SdlKind kind, const Property& property,
                  std::string_view rest) {
  const std::size_t dot = rest.find('.');
  if (dot == std::string_view::npos) {
    reader.diagnostics.add(property.place, "{} is unknown: wanted a property of a {}",
                           property.name, word_for(kind));
    return true;
  }
  switch (classify_leftover(kind, rest.substr(dot + 1), property)) {
    case Leftover::no_effect:
      return true;
    case Leftover::not_supported:
      reader.diagnostics.add(property.place, "{} = {} is not supported yet", property.name,
                             fmt::join(property.values, " "));
      return true;
    case Leftover::unknown:
      break;
  }
  return false;
}

void report_misplaced(SdlReader& reader, const Property& property, std::string_view what) {
  const auto misplaced =
      std::find_if(std::begin(k_scene_kinds), std::end(k_scene_kinds),
                   [&](SdlKind k) { return is_below(property.name, section_of(k)); });
  const auto elsewhere =
      std::find_if(std::begin(k_elsewhere), std::end(k_elsewhere),
                   [&](const Elsewhere& e) { return is_below(property.name, e.prefix); });
  if (misplaced != std::end(k_scene_kinds))
    reader.diagnostics.add(property.place, "{} does not belong in {}", property.name, what);
  else if (elsewhere != std::end(k_elsewhere))
    reader.diagnostics.add(property.place, "{} {}", property.name, elsewhere->reason);
  else
    reader.diagnostics.add(property.place, "{} is unknown", property.name);
}

}  // namespace

void report_unused(SdlReader& reader, std::span<const SdlKind> kinds, std::string_view what) {
  std::vector<UnknownOfNode> unknown;
  std::set<std::string, std::less<>> said;  // sections that do not belong here: one finding each
  for (const Property* property : reader.properties.unused()) {
    const std::string_view name = property->name;
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                   [&](SdlKind k) { return is_below(name, section_of(k)); });
    if (kind == kinds.end()) {
      const std::size_t dot = name.find('.');
      const std::size_t end = name.starts_with("scene.") ? name.find('.', dot + 1) : dot;
      if (said.emplace(name.substr(0, end)).second) report_misplaced(reader, *property, what);
      continue;
    }
    const std::string_view rest = name.substr(section_of(*kind).size() + 1);
    if (report_known(reader, *kind, *property, rest)) continue;
    const std::string_view node = rest.substr(0, rest.find('.'));
    auto entry = std::find_if(unknown.begin(), unknown.end(), [&](const UnknownOfNode& u) {
      return u.kind == *kind && u.node == node;
    });
    if (entry == unknown.end())
      entry = unknown.insert(unknown.end(), {std::string(node), *kind, {}});
    entry->properties.push_back(property);
  }
  for (const UnknownOfNode& one : unknown)
    report_unknown(reader, one);
}

void mend_section_names(SdlReader& reader) {
  std::vector<std::string_view> sections;
  for (const SdlSection* section : sdl_sections())
    sections.push_back(section_of(section->kind));
  for (const Elsewhere& elsewhere : k_elsewhere)
    sections.push_back(elsewhere.prefix);
  std::map<std::string, std::string_view> misspelt;
  for (const Property* property : reader.properties.unused()) {
    const std::string& name = property->name;
    const std::size_t end = name.find('.', name.find('.') + 1);
    if (end == std::string::npos) continue;  // nothing is below it: no section, whatever its name
    const std::string prefix = name.substr(0, end);
    const bool known = std::any_of(sections.begin(), sections.end(),
                                   [&](std::string_view s) { return is_below(name, s); });
    if (known || misspelt.contains(prefix)) continue;
    const std::string_view meant = nearest(prefix, sections);
    if (meant.empty()) continue;
    misspelt.emplace(prefix, meant);
    reader.diagnostics.add(property->place, "{} is no section of a scene, did you mean {}?", prefix,
                           meant);
  }
  for (const auto& [prefix, meant] : misspelt)
    reader.properties.rename_prefix(prefix, meant);
}

std::string_view meant_property(const SdlSection& section, const SdlTypeRow* row,
                                std::string_view unknown) {
  std::vector<std::string_view> names = parameter_names(section, row);
  if (section.types.size() > 1) names.emplace_back("type");
  return nearest(unknown, names);
}

void SdlNode::refuse_type(std::string_view type) const {
  reader_->properties.use_all(prefix_);
  error("type", "{}", unknown_type(*section_, type));
}

void SdlNode::miss(std::span<const std::string_view> properties, std::string_view what) const {
  reader_->broken.insert(prefix_);
  for (const Property* property : reader_->properties.unused()) {
    if (!is_below(property->name, prefix_)) continue;
    const std::string_view name = std::string_view(property->name).substr(prefix_.size() + 1);
    if (find_parameter(*section_, row_, name) != nullptr) continue;
    const std::string_view meant = meant_property(*section_, row_, name);
    if (meant == "type") return;
    if (std::find(properties.begin(), properties.end(), meant) != properties.end()) return;
  }
  error("", "{}", what);
}

void SdlNode::miss(std::string_view property) const {
  miss(std::span(&property, 1), fmt::format("{} is missing", property));
}

void SdlNode::miss_named(std::string_view property, SdlKind kind, const std::string& found,
                         const std::vector<std::string>& known) const {
  reader_->broken.insert(prefix_);
  const std::string wanted = fmt::format("{}.{}", section_of(kind), found);
  if (reader_->broken.contains(wanted) || !reader_->missed.insert(wanted).second) return;
  const std::vector<std::string_view> names(known.begin(), known.end());
  error(property, "{} \"{}\" is not defined above{}", word_for(kind), found,
        known_words(found, names));
}

}  // namespace ds

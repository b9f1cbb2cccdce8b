// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_prune.h"
#include "tracer/scene/sdl_reader.h"

#include <algorithm>
#include <span>

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

void report_node_property(SdlReader& reader, SdlKind kind, const Property& property) {
  const std::string_view rest = std::string_view(property.name).substr(section_of(kind).size() + 1);
  const std::size_t dot = rest.find('.');
  if (dot == std::string_view::npos) {
    reader.diagnostics.add(property.place, "{} is unknown: wanted a property of a {}",
                           property.name, word_for(kind));
    return;
  }
  switch (classify_leftover(kind, rest.substr(dot + 1), property)) {
    case Leftover::no_effect:
      return;
    case Leftover::not_supported:
      reader.diagnostics.add(property.place, "{} = {} is not supported yet", property.name,
                             fmt::join(property.values, " "));
      return;
    case Leftover::unknown:
      break;
  }
  const Property* type =
      reader.properties.find(fmt::format("{}.{}.type", section_of(kind), rest.substr(0, dot)));
  reader.diagnostics.add(property.place, "{} is unknown to a {}{}{}", property.name, word_for(kind),
                         type ? " of type " : "", type ? type->values.front() : "");
}

/// Says of each property that nobody took why not. `kinds` are those that may stand in the file.
void report_unused(SdlReader& reader, std::span<const SdlKind> kinds, std::string_view what) {
  for (const Property* property : reader.properties.unused()) {
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](SdlKind k) {
      return is_below(property->name, section_of(k));
    });
    if (kind != kinds.end()) {
      report_node_property(reader, *kind, *property);
      continue;
    }
    const auto misplaced =
        std::find_if(std::begin(k_scene_kinds), std::end(k_scene_kinds),
                     [&](SdlKind k) { return is_below(property->name, section_of(k)); });
    const auto elsewhere =
        std::find_if(std::begin(k_elsewhere), std::end(k_elsewhere),
                     [&](const Elsewhere& e) { return is_below(property->name, e.prefix); });
    if (misplaced != std::end(k_scene_kinds))
      reader.diagnostics.add(property->place, "{} does not belong in {}", property->name, what);
    else if (elsewhere != std::end(k_elsewhere))
      reader.diagnostics.add(property->place, "{} {}", property->name, elsewhere->reason);
    else
      reader.diagnostics.add(property->place, "{} is unknown", property->name);
  }
}

void require_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    fail(ErrorKind::asset, "{}: file does not exist", file.string());
}

}  // namespace

Scene read_material(const std::filesystem::path& file) {
  require_file(file);
  Diagnostics diagnostics(ErrorKind::asset);
  PropertySet properties = PropertySet::read(file, diagnostics);
  SdlReader reader(std::move(properties), file.parent_path(), diagnostics);
  read_textures(reader);
  read_materials(reader);
  report_unused(reader, std::span(k_scene_kinds).first(2), "a material file");
  if (diagnostics.empty() && reader.scene.materials.empty())
    diagnostics.add({file.string()}, "wanted a material, found no scene.materials");
  diagnostics.throw_if_any();
  return prune_to_last_material(std::move(reader.scene));
}

Scene read_environment(const std::filesystem::path& folder) {
  const std::filesystem::path scene_file = folder / "environment.scn";
  const std::filesystem::path film_file = folder / "environment.cfg";
  require_file(scene_file);
  Diagnostics diagnostics(ErrorKind::asset);
  PropertySet scene_properties = PropertySet::read(scene_file, diagnostics);
  SdlReader reader(std::move(scene_properties), folder, diagnostics);
  reader.environment = true;
  read_textures(reader);
  read_materials(reader);
  read_shapes(reader);
  read_objects(reader);
  read_lights(reader);
  report_unused(reader, k_scene_kinds, "a scene file");

  std::error_code ignored;
  const bool has_film = std::filesystem::exists(film_file, ignored);
  PropertySet film_properties =
      has_film ? PropertySet::read(film_file, diagnostics) : PropertySet{};
  SdlReader film(std::move(film_properties), folder, diagnostics);
  reader.scene.tone_map = read_tone_map(film);
  constexpr SdlKind k_film[] = {SdlKind::film};
  report_unused(film, k_film, "a film file");
  diagnostics.throw_if_any();
  return prune_environment(std::move(reader.scene));
}

}  // namespace ds

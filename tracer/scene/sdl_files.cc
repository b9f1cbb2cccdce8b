// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_prune.h"
#include "tracer/scene/sdl_reader.h"
#include "tracer/scene/sdl_warn.h"
#include "tracer/scene/vary_nodes.h"

#include <span>

namespace ds {
namespace {

constexpr SdlKind k_scene_kinds[] = {SdlKind::texture, SdlKind::material, SdlKind::shape,
                                     SdlKind::object, SdlKind::light};

void require_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) return;
  if (std::filesystem::exists(file, ignored))
    fail(ErrorKind::asset, "{}: wanted a file, found a folder or a device", file.string());
  fail(ErrorKind::asset, "{}: file does not exist", file.string());
}

}  // namespace

Scene read_material(const std::filesystem::path& file, const ContentOf& content_of) {
  require_file(file);
  Diagnostics diagnostics(ErrorKind::asset);
  PropertySet properties = PropertySet::read(file, diagnostics);
  SdlReader reader(std::move(properties), file.parent_path(), diagnostics);
  if (content_of) reader.content_of = content_of;
  mend_section_names(reader);
  read_textures(reader);
  read_materials(reader);
  const std::span kinds = std::span(k_scene_kinds).first(2);
  report_unused(reader, kinds, "a material file");
  report_slips(reader, kinds);
  if (diagnostics.empty() && reader.scene.materials.empty())
    diagnostics.add({file.string()}, "wanted a material, found no scene.materials");
  diagnostics.throw_if_any();
  bool unlikely = warn_of_repeats(reader.properties);
  unlikely |= warn_of_spare(reader, kinds);
  Scene material = prune_to_last_material(std::move(reader.scene));
  material.unlikely = unlikely;
  warn_of_materials(material);
  return material;
}

Scene read_environment(const std::filesystem::path& folder, EnvironmentSource* source,
                       const ContentOf& content_of) {
  const std::filesystem::path scene_file = folder / "environment.scn";
  const std::filesystem::path film_file = folder / "environment.cfg";
  require_file(scene_file);
  Diagnostics diagnostics(ErrorKind::asset);
  const std::string scene_text = read_text_file(scene_file);
  SdlReader reader(PropertySet::parse(scene_text, scene_file.string(), diagnostics), folder,
                   diagnostics);
  reader.environment = true;
  if (content_of) reader.content_of = content_of;
  mend_section_names(reader);
  read_textures(reader);
  read_materials(reader);
  read_shapes(reader);
  read_objects(reader);
  read_lights(reader);
  report_unused(reader, k_scene_kinds, "a scene file");
  report_slips(reader, k_scene_kinds);

  std::error_code ignored;
  const bool has_film = std::filesystem::exists(film_file, ignored);
  PropertySet film_properties =
      has_film ? PropertySet::read(film_file, diagnostics) : PropertySet{};
  SdlReader film(std::move(film_properties), folder, diagnostics);
  mend_section_names(film);
  reader.scene.tone_map = read_tone_map(film);
  constexpr SdlKind k_film[] = {SdlKind::film};
  report_unused(film, k_film, "a film file");
  diagnostics.throw_if_any();
  bool unlikely = warn_of_repeats(reader.properties);
  unlikely |= warn_of_repeats(film.properties);
  unlikely |= warn_of_spare(reader, k_scene_kinds);
  if (source != nullptr) {
    *source = {std::move(reader.files), node_lines(scene_text)};
    source->files.insert(source->files.end(), {scene_file, film_file});
  }
  Scene environment = prune_environment(std::move(reader.scene));
  warn_of_materials(environment);
  for (const std::string& line : environment.mended_meshes)
    warn(line);
  environment.unlikely = warn_of_environment(environment, folder.string()) || unlikely;
  return environment;
}

}  // namespace ds

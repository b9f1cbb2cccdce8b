// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/plane_keys.h"

#include "builder/plan/environment_vary.h"
#include "builder/plan/image_material.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/keys.h"
#include "tracer/base/canonical.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <array>
#include <span>

namespace ds {
namespace {

/// Version of how planes are traced.
constexpr int k_geometry_version = 1;

constexpr std::array<const char*, 2> k_plane_parts = {"model", "material_id"};
/// Of a plane that reads materials.
constexpr std::array<const char*, 3> k_colour_parts = {"program", "model", "material"};

void add_vector(CanonicalText& text, std::string_view name, Vec3d v) {
  const double values[] = {v.x, v.y, v.z};
  text.add(name, std::span<const double>(values));
}

}  // namespace

TextForm output_form(std::string_view kind, std::string_view format,
                     const std::string& development) {
  CanonicalText text;
  text.add("kind", kind);
  text.add("from", "");
  text.add("format", format);
  return {text.text() + development, {"from"}};
}

WantedPlane wanted_plane(const OutputKind& kind) {
  WantedPlane plane;
  plane.type = kind.plane;
  if (!reads_materials(*kind.plane) && !is_of_light(*kind.plane))
    plane.program = hash_text(program_tokens(planes_program_text(std::array{kind.plane})));
  plane.reads.uvs = (kind.plane->traits & kernels::k_plane_uvs) != 0;
  plane.reads.normals = (kind.plane->traits & kernels::k_plane_normals) != 0;
  plane.output = output_form(kind.kind, kind.format, "");
  return plane;
}

/// Of a plane of the model alone the environment is no part.
TextForm plane_form(const WantedPlane& plane, const std::map<unsigned, std::string>& shapes,
                    const ImageSpec& image, const EnvironmentChange& change,
                    const std::string& others) {
  const bool alone = (plane.type->traits & kernels::k_plane_alone) != 0;
  const bool colours = reads_materials(*plane.type);
  CanonicalText text;
  text.add("version", k_geometry_version);
  text.add("host_version", k_host_render_version);
  if (!colours) text.add("program", plane.program.hex());
  const std::span<const char* const> parts =
      colours ? std::span<const char* const>(k_colour_parts) : k_plane_parts;
  for (const char* part : parts)
    text.add(part, "");
  text.add("environment", alone ? "" : shapes.at(plane_reads(*plane.type)));
  std::string changed = alone ? "" : canonical_turn(change.turn_deg);
  if (colours && !alone) changed += canonical_values(change.values, ValuesOf::colours);
  add_vector(text, "camera.position", image.camera.position);
  add_vector(text, "camera.target", image.camera.target);
  add_vector(text, "camera.up", image.camera.up);
  const CameraType& type = type_of(image.camera);
  if (image.camera.type != 0) text.add("camera.type", type.name);
  text.add(fmt::format("camera.{}", type.span_name()), span_of(image.camera));
  text.add("width", image.engine.width);
  text.add("height", image.engine.height);
  return {text.text() + changed + others, parts};
}

Hash128 plane_program(const PlaneType& plane, const std::string& of, const Recipe& recipe,
                      Inputs& inputs, const ImageSpec& image) {
  const std::string question = fmt::format("program of {} {}", plane.name, of);
  if (const auto known = inputs.find_known(question))
    if (const auto hash = Hash128::from_hex(*known)) return *hash;
  const SceneEffects effects =
      scene_effects(scene_without_model(recipe, inputs, image), image.camera);
  std::vector alone{&plane};
  if ((plane.traits & kernels::k_plane_cut_out) != 0) alone.push_back(&plane_type("alpha"));
  const Hash128 hash = hash_text(
      program_tokens(is_of_light(plane) ? path_program_text(with_light_planes(effects, alone))
                                        : planes_program_text(alone, effects)));
  inputs.keep_known(question, hash.hex());
  return hash;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/plane_types.h"

#include "tracer/base/error.h"
#include "tracer/device/program_assembly.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/planes/list.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>

namespace ds {

static_assert(k_model_object_id == k_model_object);

std::span<const PlaneType> plane_types() {
#define DS_PLANE_ROW(name) \
  PlaneType{#name, kernels::name##_width, unsigned{kernels::name##_traits}},
  static constexpr std::array rows = {DS_ALL_PLANES(DS_PLANE_ROW)};
#undef DS_PLANE_ROW
  return rows;
}

const PlaneType* find_plane(std::string_view name) {
  const auto rows = plane_types();
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const PlaneType& plane) { return plane.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

const PlaneType& plane_type(std::string_view name) {
  const PlaneType* plane = find_plane(name);
  DS_ASSERT(plane != nullptr);
  return *plane;
}

bool is_of_light(const PlaneType& plane) {
  return (plane.traits & kernels::k_plane_light) != 0;
}

SceneEffects with_light_planes(SceneEffects effects, std::span<const PlaneType* const> planes) {
  for (const PlaneType* plane : planes) {
    DS_ASSERT(is_of_light(*plane));
    effects.light_planes.emplace_back(plane->name);
  }
  return effects;
}

bool is_of_model_alone(const PlaneType& plane) {
  return (plane.traits & kernels::k_plane_alone) != 0;
}

bool reads_materials(const PlaneType& plane) {
  return (plane.traits & kernels::k_plane_materials) != 0;
}

std::string planes_program_text(std::span<const PlaneType* const> planes,
                                const SceneEffects& effects) {
  unsigned traits = 0;
  int before = 0;
  std::string list = "#define DS_PLANES(X)";
  std::vector<std::string> headers;
  for (const PlaneType* plane : planes) {
    DS_ASSERT(!is_of_light(*plane));
    list += fmt::format(" X({}, {})", plane->name, before);
    before += plane->width;
    traits |= plane->traits;
    headers.push_back(fmt::format("tracer/kernels/planes/{}.h", plane->name));
  }
  list += "\n";
  if ((traits & kernels::k_plane_surface) != 0) list += "#define DS_PLANE_SURFACE\n";
  if ((traits & kernels::k_plane_material_ids) != 0) list += "#define DS_PLANE_MATERIAL_IDS\n";
  if ((traits & kernels::k_plane_materials) != 0) {
    list += "#define DS_HOOK_ALBEDO\n" + material_definitions(effects);
    const std::vector<std::string> files = material_files(effects);
    headers.insert(headers.begin(), files.begin(), files.end());
  }
  headers.emplace_back("tracer/kernels/first_hit.cl");
  return assemble(list, headers);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/pack_rows.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>

namespace ds {
namespace {

bool reads_colors(const SceneEffects& effects) {
  return std::any_of(texture_types().begin(), texture_types().end(), [&](const NodeType& type) {
    return reads_colors(type) && SceneEffects::number(effects.textures, type.kernel_prefix) >= 0;
  });
}

}  // namespace

std::uint32_t pack_colors(const Scene& scene, const SceneEffects& effects, Words& tables) {
  const std::uint32_t offset = tables.offset();
  if (!reads_colors(effects)) return offset;
  const auto add = [&](const MeshColor& color) {
    for (const float component : color)
      tables.add(component);
  };
  constexpr MeshColor k_white{1, 1, 1, 1};
  for (int corner = 0; corner < 3; ++corner)
    add(k_white);
  for (const Object& object : scene.objects)
    for (const auto& triangle : object.mesh.triangles)
      for (const std::uint32_t corner : triangle)
        add(object.mesh.colors.empty() ? k_white : object.mesh.colors[corner]);
  return offset;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/scene/mesh.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ds {

template <typename Position>
void check_mesh(const BasicMesh<Position>& mesh) {
  DS_ASSERT(!mesh.triangles.empty());
  DS_ASSERT(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  DS_ASSERT(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  DS_ASSERT(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
  for (const ds::MeshColor& c : mesh.colors)
    DS_ASSERT(c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && std::isfinite(c[3]));
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t)
      DS_ASSERT(v < mesh.positions.size());
  for (const Position p : mesh.positions)
    DS_ASSERT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const Vec3 n : mesh.normals)
    DS_ASSERT(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z));
}

/// Reads and normalises: a sound mesh or an Error(asset), nothing else.
inline void fuzz_model(std::string_view bytes, const std::string& name) {
  try {
    const Model model = parse_model(bytes, name);
    check_mesh(model.mesh);
    for (const Normals normals : {Normals::smooth, Normals::flat, Normals::keep}) {
      NormaliseOptions options;
      options.normals = normals;
      if (normals != Normals::keep || model.report.has_normals)
        check_mesh(normalise(model.mesh, options));
    }
  } catch (const Error& error) {
    DS_ASSERT(error.kind() == ErrorKind::asset);
  }
}

}  // namespace ds

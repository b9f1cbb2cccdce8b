// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/scene/mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

inline constexpr float k_no_alpha = -1;

/// Colours of an integer type that runs further: what is up to these uses 1/255 of it at most.
/// 0 for other types.
struct DarkColors {
  float color = 0, alpha = 0;
};

/// What a reader passes over, see MeshReport.
struct UnusedParts {
  std::uint64_t places = 0, normals = 0, uvs = 0, colors = 0;
  std::uint64_t materials = 0, attributes = 0, elements = 0, surfaces = 0, lines = 0, poses = 0;
};
/// What a file gives to others of its corners, vertices or faces, see MeshReport.
struct MissingParts {
  std::uint64_t uvs = 0, colors = 0;
};

/// A model as a reader finds it: polygons of any size, nothing checked or mended. Indices that are
/// not in [0, 2^32 - 1) are 2^32 - 1; any may be at or above the vertex count. `normals`,
/// `uvs` and `colors` are empty or as long as `positions`. No -0. Colours are as the file has them
/// until `unit_colors`; an alpha of k_no_alpha says that there is none.
struct Polygons {
  std::vector<Vec3d> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<MeshColor> colors;
  std::vector<std::uint32_t> corners;  ///< vertex indices of all faces, one face after another
  std::vector<std::size_t> face_ends;  ///< where in `corners` each face ends
  std::vector<Vec2> corner_uvs;        ///< empty or as long as `corners`; goes before `uvs`
  std::vector<Vec3> corner_normals;    ///< likewise before `normals`
  std::vector<MeshColor> face_colors;  ///< empty or one a face; where there are no `colors`
  /// Empty or one a face: from 1, in the order in which faces first name them; 0: none.
  std::vector<std::uint32_t> face_materials{};
  std::vector<std::string> material_names{};  ///< of these, from number 1 on
  DarkColors dark_colors, dark_face_colors;
  UnusedParts unused;
  MissingParts missing;
  bool counts_from_1 = false;      ///< in the file, as its format wants it
  std::size_t trailing_bytes = 0;  ///< behind what the header promises

  std::span<const std::uint32_t> face(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : face_ends[i - 1];
    return std::span(corners).subspan(begin, face_ends[i] - begin);
  }
};

/// Triangulates, and mends what MeshReport lists. Throws Error(asset) where no triangle is left, and
/// where indices count from 1.
Model mend(Polygons polygons, const std::string& name, Winding winding);

/// Colours of a file whose type does not tell their range: up to 1, or up to 16 with fractions, they
/// are shares of light as they stand; else they run to 255, or to 65535 where some value is above
/// 255. Alpha by its own values; one that is not there becomes 1.
void unit_colors(std::vector<MeshColor>& colors);

/// The colour of what a file gives none although it gives others one, until white takes its place:
/// in the range of the others.
inline constexpr MeshColor k_missing_color{-1, -1, -1, -1};
/// Returns how many there were.
std::uint64_t fill_missing_colors(std::vector<MeshColor>& colors);

/// Gives each corner that has a uv, a normal or a colour of its own a vertex of its own, so that all
/// stand at vertices; corners that agree share one. A vertex stays in its place for the first of its corners; those of
/// further ones follow behind all. Leaves polygons without any as they are. Colours of vertices go
/// before those of faces, uvs and normals of corners before those of vertices. Counts what is passed over, and
/// colours hardly meant.
void split_corners(Polygons& polygons, MeshReport& report);

/// A double from a file as the float a mesh holds: too large becomes infinite, -0 becomes 0.
float to_mesh_float(double value);
inline Vec3 to_mesh_floats(Vec3d v) {
  return {to_mesh_float(v.x), to_mesh_float(v.y), to_mesh_float(v.z)};
}

/// How many items of at least `item_bytes` to reserve room for when a header promises `promised`
/// and `bytes_left` bytes follow.
std::size_t believable(std::uint64_t promised, std::size_t bytes_left, std::size_t item_bytes);

}  // namespace ds

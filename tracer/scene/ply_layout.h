// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/ply_header.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a vertex property is for. A row of values has one place for each but `skipped`.
enum PlySlot : std::size_t {
  k_x,
  k_y,
  k_z,
  k_nx,
  k_ny,
  k_nz,
  k_u,
  k_v,
  k_red,
  k_green,
  k_blue,
  k_alpha,
  k_slots,
  k_skipped = k_slots
};
using PlyRow = std::array<double, k_slots>;

/// Kinds of properties that have names which stand together.
enum class PlyKind : std::size_t { place, normal, uv, color, alpha };
inline constexpr std::size_t k_ply_kinds = 5;

/// Whether a name of the file is `name`, which is in small letters: in any case, as other readers
/// have it.
bool is_ply_name(std::string_view found, std::string_view name);

/// Which properties of an element are read, and as what.
struct PlyLayout {
  std::vector<PlySlot> slots;  ///< one a property
  std::array<bool, k_ply_kinds> has{};
  DarkColors dark_colors;
  UnusedParts unused;

  bool has_kind(PlyKind kind) const { return has[static_cast<std::size_t>(kind)]; }
  /// A whole colour, or an alpha alone, whose colour is white.
  bool has_colors() const { return has_kind(PlyKind::color) || has_kind(PlyKind::alpha); }
};

/// Of a vertex. Of names that mean the same (u and s, red and diffuse_red) those count that are whole
/// and begin first. Throws Error(asset) where it has no place.
PlyLayout vertex_layout(const PlyElement& vertex, const std::string& name);

/// What is read of the faces of one element.
struct PlyFaceLayout {
  std::size_t corners = 0;  ///< number of the property that lists them
  std::size_t uvs = 0;      ///< likewise; that of no property where there are none
  PlyLayout colors;
};
PlyFaceLayout face_layout(const PlyElement& face, const std::string& name);

/// Which property of a face or strip lists its corners. Throws Error(asset) where none or two do.
std::size_t corner_list_of(const PlyElement& face, const std::string& name);

/// What a colour's value of that type is divided by.
double ply_color_range(PlyType type);

}  // namespace ds

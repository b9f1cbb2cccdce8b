// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh_outward.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_topology.h"
#include "tracer/scene/mesh_triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace ds {
namespace {

/// So that three corners of every triangle can be numbered in 32 bits.
constexpr std::uint64_t k_most_triangles = std::uint64_t{1} << 29U;
constexpr std::uint64_t k_most_vertices = std::uint64_t{1} << 30U;

bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_finite(const MeshColor& c) {
  return std::all_of(c.begin(), c.end(), [](float x) { return std::isfinite(x); });
}
bool is_finite(Vec2 v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}
bool is_usable(Vec3d p) {
  const auto near = [](double x) { return std::fabs(x) <= k_farthest_coordinate; };
  return near(p.x) && near(p.y) && near(p.z);  // false for NaN
}

void count_faces(const Polygons& polygons, MeshReport& report) {
  report.vertices = polygons.positions.size();
  report.faces = polygons.face_ends.size();
  for (std::size_t i = 0; i < polygons.face_ends.size(); ++i) {
    const std::size_t corners = polygons.face(i).size();
    if (corners > 3) ++report.n_gons;
    if (corners < 3)
      ++report.short_faces;
    else
      report.triangles += corners - 2;
  }
}

/// Such a file loses the faces at its last vertex, and all others are of wrong vertices.
void refuse_indices_from_1(const Polygons& polygons, const std::string& name) {
  if (polygons.corners.empty() || polygons.counts_from_1) return;
  const auto [least, most] = std::minmax_element(polygons.corners.begin(), polygons.corners.end());
  if (*least == 1 && *most == polygons.positions.size())
    fail(
        ErrorKind::asset,
        "{}: its faces' indices run from 1 to {}, the number of its vertices: they must count from "
        "0, take 1 off each",
        name, *most);
}

std::vector<char> find_usable(const std::vector<Vec3d>& positions, MeshReport& report) {
  std::vector<char> usable(positions.size());
  for (std::size_t v = 0; v < usable.size(); ++v) {
    usable[v] = is_usable(positions[v]) ? 1 : 0;
    if (!usable[v]) ++report.non_finite;
  }
  return usable;
}

/// Whether floats hold the faces' coordinates to about a ten-millionth of the mesh's longest side,
/// as they do at its origin: half a unit in the last place of four times that side.
bool floats_hold(const Polygons& polygons, const std::vector<char>& usable) {
  constexpr double k_farthest_in_sides = 4;
  constexpr double k_least_side = 0x1p-100;  // its square is still a number to floats
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> least{k_infinity, k_infinity, k_infinity};
  std::array<double, 3> most{-k_infinity, -k_infinity, -k_infinity};
  for (const std::uint32_t v : polygons.corners) {
    if (v >= usable.size() || usable[v] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = polygons.positions[v][static_cast<int>(axis)];
      least[axis] = std::min(least[axis], x);
      most[axis] = std::max(most[axis], x);
    }
  }
  double side = 0, farthest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side = std::max(side, most[axis] - least[axis]);
    farthest = std::max({farthest, std::fabs(least[axis]), std::fabs(most[axis])});
  }
  return side >= k_least_side && farthest <= k_farthest_in_sides * side;
}

/// The triangles of all faces whose corners exist and are usable, with their faces' materials.
void triangulate_usable(const Polygons& polygons, const std::vector<char>& usable,
                        const std::string& name, FileMesh& mesh, MeshReport& report) {
  std::vector<Triangle>& triangles = mesh.triangles;
  triangles.reserve(report.triangles);
  Triangulator triangulator;
  for (std::size_t i = 0; i < polygons.face_ends.size(); ++i) {
    const auto face = polygons.face(i);
    if (face.size() < 3) continue;
    if (std::any_of(face.begin(), face.end(), [&](auto v) { return v >= usable.size(); }))
      ++report.out_of_range;
    else if (std::all_of(face.begin(), face.end(), [&](auto v) { return usable[v] != 0; }) &&
             !triangulator.triangulate(polygons.positions, face, triangles))
      fail(ErrorKind::asset,
           "{}: face {} (from 0) of {} corners would take too long to be cut into triangles: let "
           "what "
           "wrote it cut its faces",
           name, i, face.size());
    if (!polygons.face_materials.empty())
      mesh.materials.resize(triangles.size(), polygons.face_materials[i]);
  }
}

/// No area within the rounding of double arithmetic on the file's coordinates: corners that coincide or
/// lie exactly on one line. A sliver that floats can tell from a line is kept; without it a mesh
/// would have a crack.
bool has_no_area(Vec3d a, Vec3d b, Vec3d c) {
  constexpr double k_relative = 0x1p-48;  // a few roundings of 2^-53
  const Vec3d ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
  return !(length(cross(ab, ac)) > k_relative * longest);
}

/// Removes what is not to stay, with its material; returns how many.
template <typename Stays>
std::size_t keep_triangles(FileMesh& mesh, const Stays& stays) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!stays(i)) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    if (!mesh.materials.empty()) mesh.materials[kept] = mesh.materials[i];
    ++kept;
  }
  const std::size_t removed = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  if (!mesh.materials.empty()) mesh.materials.resize(kept);
  return removed;
}

/// Returns those removed whose corners are three places: on one line, where they may join others.
std::vector<Triangle> remove_zero_area(FileMesh& mesh, MeshReport& report) {
  std::vector<Triangle> flat;
  report.zero_area = keep_triangles(mesh, [&](std::size_t i) {
    const Triangle t = mesh.triangles[i];
    const Vec3d a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    if (!has_no_area(a, b, c)) return true;
    if (a != b && b != c && c != a) flat.push_back(t);
    return false;
  });
  return flat;
}

void remove_duplicates(FileMesh& mesh, const std::vector<std::uint32_t>& welded,
                       MeshReport& report) {
  std::vector<Triangle> keys;
  keys.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Triangle key{welded[t[0]], welded[t[1]], welded[t[2]]};
    std::sort(key.begin(), key.end());
    keys.push_back(key);
  }
  const std::vector<std::uint32_t> first = first_equal<3>(keys);
  report.duplicate_faces = keep_triangles(mesh, [&](std::size_t i) { return first[i] == i; });
}

/// Normals to unit length, and zero for what is not finite.
void mend_attributes(FileMesh& mesh, MeshReport& report) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    bool bad = false;
    if (!mesh.normals.empty()) {
      bad = !is_finite(mesh.normals[v]);
      const Vec3d unit = bad ? Vec3d{} : normalized(to_double(mesh.normals[v]));
      if (!bad && unit == Vec3d{}) ++report.zero_normals;
      mesh.normals[v] = to_mesh_floats(unit);
    }
    if (!mesh.uvs.empty() && !is_finite(mesh.uvs[v])) {
      bad = true;
      mesh.uvs[v] = {};
    }
    if (!mesh.colors.empty() && !is_finite(mesh.colors[v])) {
      bad = true;
      for (float& component : mesh.colors[v])
        if (!std::isfinite(component)) component = 0;
    }
    if (bad) ++report.bad_attributes;
  }
}

/// Moves what triangles use to the front, in the file's order.
void drop_unreferenced(FileMesh& mesh, MeshReport& report) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      used[v] = 1;
  std::vector<std::uint32_t> renumbered(used.size());
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    renumbered[v] = kept;
    if (!used[v]) continue;
    mesh.positions[kept] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[v];
    if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[v];
    ++kept;
  }
  report.unreferenced = used.size() - kept;
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  if (!mesh.colors.empty()) mesh.colors.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      v = renumbered[v];
}

MendedDamage counts_with(const MeshReport& report, const char* MeshReportColumn::*text) {
  MendedDamage counts;
  for (const MeshReportColumn& column : k_mesh_report_columns)
    if (column.*text != nullptr && report.*column.count > 0)
      counts.emplace_back(column.name, report.*column.count);
  return counts;
}

}  // namespace

MendedDamage mended_damage(const MeshReport& report) {
  return counts_with(report, &MeshReportColumn::damage);
}

MendedDamage unlikely_properties(const MeshReport& report) {
  return counts_with(report, &MeshReportColumn::unlikely);
}

const MeshReportColumn* mesh_report_column(std::string_view name) {
  const auto* const at = std::find_if(k_mesh_report_columns.begin(), k_mesh_report_columns.end(),
                                      [&](const MeshReportColumn& c) { return name == c.name; });
  return at == k_mesh_report_columns.end() ? nullptr : at;
}

bool loses_faces(const MendedDamage& damage) {
  return std::any_of(damage.begin(), damage.end(), [](const auto& what) {
    const MeshReportColumn* const column = mesh_report_column(what.first);
    return column != nullptr && column->loses_faces;
  });
}

std::string to_text(const MendedDamage& damage) {
  std::string text;
  for (const auto& [name, count] : damage) {
    const MeshReportColumn* const column = mesh_report_column(name);
    const bool known = column != nullptr && column->damage != nullptr;
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", known ? column->damage : name.c_str(),
                        count);
  }
  return text;
}

Model mend(Polygons polygons, const std::string& name, Winding winding) {
  Model model;
  MeshReport& report = model.report;
  count_faces(polygons, report);
  report.trailing_bytes = polygons.trailing_bytes;
  report.unused_places = polygons.unused.places;
  report.unused_normals = polygons.unused.normals;
  report.unused_uvs = polygons.unused.uvs;
  report.unused_colors = polygons.unused.colors;
  report.unused_materials = polygons.unused.materials;
  report.unused_attributes = polygons.unused.attributes;
  report.unused_elements = polygons.unused.elements;
  report.unused_surfaces = polygons.unused.surfaces;
  report.unused_poses = polygons.unused.poses;
  report.unknown_lines = polygons.unused.lines;
  report.missing_uvs = polygons.missing.uvs;
  report.missing_colors = polygons.missing.colors;
  refuse_indices_from_1(polygons, name);
  split_corners(polygons, report);
  if (report.vertices > k_most_vertices || report.triangles > k_most_triangles)
    fail(ErrorKind::asset, "{}: at most {} vertices and {} triangles can be used, got {} and {}",
         name, k_most_vertices, k_most_triangles, report.vertices, report.triangles);

  const std::vector<char> usable = find_usable(polygons.positions, report);
  if (floats_hold(polygons, usable))
    for (Vec3d& p : polygons.positions)
      p = to_double(to_mesh_floats(p));
  FileMesh& mesh = model.mesh;
  triangulate_usable(polygons, usable, name, mesh, report);
  mesh.positions = std::move(polygons.positions);
  mesh.normals = std::move(polygons.normals);
  mesh.uvs = std::move(polygons.uvs);
  mesh.colors = std::move(polygons.colors);
  report.has_colors = !mesh.colors.empty();
  // White is what a mesh without colours has: the same mesh.
  constexpr MeshColor k_white{1, 1, 1, 1};
  if (std::all_of(mesh.colors.begin(), mesh.colors.end(),
                  [&](const MeshColor& c) { return c == k_white; }))
    mesh.colors.clear();
  const std::vector<Triangle> flat = remove_zero_area(mesh, report);
  const std::vector<std::uint32_t> welded = weld(mesh.positions);
  remove_duplicates(mesh, welded, report);
  if (mesh.triangles.empty())
    fail(
        ErrorKind::asset,
        "{}: no triangle is left of {} faces: {} short, {} with an index out of range, {} vertices "
        "not finite, {} triangles without area",
        name, report.faces, report.short_faces, report.out_of_range, report.non_finite,
        report.zero_area);
  if (winding == Winding::outwards) {
    const WindingReport turned = turn_outwards(mesh.positions, welded, mesh.triangles, flat);
    report.flipped = turned.turned;
    report.against = turned.against;
  }
  drop_unreferenced(mesh, report);
  mend_attributes(mesh, report);
  report.triangles_kept = mesh.triangles.size();
  report.has_normals = !mesh.normals.empty();
  report.has_uvs = !mesh.uvs.empty();
  return model;
}

std::uint64_t turn_outwards(FileMesh& mesh) {
  return turn_outwards(mesh.positions, weld(mesh.positions), mesh.triangles).turned;
}

Mesh in_floats(FileMesh mesh) {
  Mesh rounded;
  rounded.positions.reserve(mesh.positions.size());
  for (const Vec3d p : mesh.positions)
    rounded.positions.push_back(to_mesh_floats(p));
  rounded.normals = std::move(mesh.normals);
  rounded.uvs = std::move(mesh.uvs);
  rounded.colors = std::move(mesh.colors);
  rounded.triangles = std::move(mesh.triangles);
  rounded.materials = std::move(mesh.materials);
  return rounded;
}

float to_mesh_float(double value) {
  // Out of range a cast would be undefined.
  if (std::fabs(value) > double{std::numeric_limits<float>::max()})
    return std::copysign(std::numeric_limits<float>::infinity(), value < 0 ? -1.0F : 1.0F);
  return static_cast<float>(value) + 0.0F;
}

std::size_t believable(std::uint64_t promised, std::size_t bytes_left, std::size_t item_bytes) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(promised, bytes_left / item_bytes));
}

}  // namespace ds

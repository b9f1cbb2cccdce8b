// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/mesh_normals.h"
#include "tracer/scene/mesh_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace ds {
namespace {

Vec3d turned(Vec3d v, UpAxis up) {
  return up == UpAxis::y ? Vec3d{v.x, -v.z, v.y} : v;
}

/// Rows of the matrix of a unit quaternion.
std::array<Vec3d, 3> rows_of(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
          Vec3d{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
          Vec3d{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
}

/// options.turn of what is upright. Where it turns nothing no bit changes.
class Turner {
 public:
  explicit Turner(const NormaliseOptions& options)
      : turns_(turns(options)), rows_(rows_of(options.turn)) {}
  Vec3d operator()(Vec3d v) const {
    return turns_ ? Vec3d{dot(rows_[0], v), dot(rows_[1], v), dot(rows_[2], v)} : v;
  }

 private:
  bool turns_;
  std::array<Vec3d, 3> rows_;
};

/// -0 becomes 0, so that the hash of a mesh does not depend on how a zero came about.
Vec3 rounded(Vec3d v) {
  return to_float(v + Vec3d{0, 0, 0});
}

std::vector<Vec3d> turned_positions(const FileMesh& mesh, UpAxis up) {
  std::vector<Vec3d> positions;
  positions.reserve(mesh.positions.size());
  for (const Vec3d p : mesh.positions)
    positions.push_back(turned(p, up));
  return positions;
}

Vec3d in_double(Vec3 p) {
  return to_double(p);
}
Vec3d in_double(Vec3d p) {
  return p;
}

template <typename Position>
Box bounds(const std::vector<Position>& positions) {
  if (positions.empty()) return {};
  Box box{in_double(positions[0]), in_double(positions[0])};
  for (const Position& position : positions) {
    const Vec3d p = in_double(position);
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y),
                 std::min(box.least.z, p.z)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
  }
  return box;
}

double scale_of(const Box& box, const NormaliseOptions& options) {
  const Vec3d side = box.most - box.least;
  const double longest = std::max({side.x, side.y, side.z});
  DS_ASSERT(longest > 0);
  return options.size_m > 0 ? options.size_m / longest : 1;
}

/// Where the point that becomes the origin goes in the end.
Vec3d ground_of(const NormaliseOptions& options) {
  const auto [x, y, z] = options.place_m;
  return {x, y, (options.place_on_ground ? options.ground_z_m : 0) + z};
}

/// Area-weighted centroid of the surface, summed about `origin` to keep the digits of a far mesh.
Vec3d surface_centroid(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       Vec3d origin) {
  Vec3d sum;
  double area = 0;
  for (const Triangle& t : triangles) {
    const Vec3d a = positions[t[0]] - origin, b = positions[t[1]] - origin,
                c = positions[t[2]] - origin;
    const double weight = length(cross(b - a, c - a));
    sum = sum + (a + b + c) * (weight / 3);
    area += weight;
  }
  return area > 0 ? origin + sum * (1 / area) : origin;
}

Vec3d middle_of(const Box& box) {
  return (box.least + box.most) * 0.5;
}

/// Which point becomes the origin, before scaling, when the upright mesh has been turned; `lowest` is
/// then its least z.
Vec3d centre_of(const MeshExtent& upright, const NormaliseOptions& options, double lowest) {
  Vec3d centre;
  if (options.centre == Centring::mass) centre = upright.centroid;
  if (options.centre == Centring::box) centre = middle_of(upright.box);
  if (turns(options)) {
    if (!options.place_on_ground) centre.z = 0;
    centre = Turner(options)(centre);
    if (!options.place_on_ground) return centre;
  }
  centre.z = options.place_on_ground ? lowest : 0;
  return centre;
}

/// `lowest`: as lowest_of has it, of one that tilts.
Vec3d centre_of_upright(const MeshExtent& upright, const NormaliseOptions& options, double lowest) {
  return centre_of(upright, options, tilts(options) ? lowest : upright.box.least.z);
}

MeshExtent extent_of(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
  const Box box = bounds(positions);
  return {box, surface_centroid(positions, triangles, middle_of(box))};
}

MeshExtent turned(const MeshExtent& mesh, UpAxis up) {
  return {bounds(std::vector<Vec3d>{turned(mesh.box.least, up), turned(mesh.box.most, up)}),
          turned(mesh.centroid, up)};
}

/// Turns the upright positions too.
std::vector<Vec3> placed_positions(std::vector<Vec3d>& positions,
                                   const std::vector<Triangle>& triangles,
                                   const NormaliseOptions& options) {
  const MeshExtent extent = extent_of(positions, triangles);
  const double scale = scale_of(extent.box, options);
  std::transform(positions.begin(), positions.end(), positions.begin(), Turner(options));
  const Vec3d centre =
      centre_of_upright(extent, options, tilts(options) ? bounds(positions).least.z : 0);
  const Vec3d ground = ground_of(options);
  std::vector<Vec3> placed;
  placed.reserve(positions.size());
  for (const Vec3d p : positions)
    placed.push_back(rounded((p - centre) * scale + ground));
  return placed;
}

/// What single floats leave of a body this far away is not the body.
void check_digits(const std::vector<Vec3>& placed) {
  constexpr double k_least_digits = 1e-3;  // of its size: half a pixel of one that fills a picture
  const auto [least, most] = bounds(placed);
  const Vec3d side = most - least;
  const double size = std::max({side.x, side.y, side.z});
  const double farthest = std::max({-least.x, -least.y, -least.z, most.x, most.y, most.z});
  if (farthest * 0x1p-24 <= size * k_least_digits) return;
  fail(ErrorKind::asset,
       "the model, {:.5g} m in size, is placed {:.5g} m from the world's origin, where single "
       "floats cannot tell its shape: models.centre, models.ground_z_m and models.size_m place it",
       size, farthest);
}

/// For each vertex a number of its colour: equal ones have one.
std::vector<std::uint32_t> color_numbers(const std::vector<MeshColor>& colors) {
  std::vector<std::array<std::uint32_t, 4>> keys;
  for (const MeshColor& c : colors)
    keys.push_back({std::bit_cast<std::uint32_t>(c[0]), std::bit_cast<std::uint32_t>(c[1]),
                    std::bit_cast<std::uint32_t>(c[2]), std::bit_cast<std::uint32_t>(c[3])});
  return first_equal<4>(keys);
}

/// The mesh with one normal a corner. Corners that agree in place, normal, uv and colour share a
/// vertex;
/// vertices are in the order in which triangles first use them.
Mesh with_corner_normals(const FileMesh& source, const std::vector<Vec3>& placed,
                         const std::vector<std::uint32_t>& welded,
                         const std::vector<Vec3d>& corner_normals) {
  const bool has_uvs = !source.uvs.empty();
  const std::size_t corners = 3 * source.triangles.size();
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const std::vector<std::uint32_t> colors = color_numbers(source.colors);
  std::vector<std::array<std::uint32_t, 7>> keys;
  keys.reserve(corners);
  for (std::size_t c = 0; c < corners; ++c) {
    const std::uint32_t v = source.triangles[c / 3][c % 3];
    const Vec3 n = rounded(corner_normals[c]);
    const Vec2 uv = has_uvs ? source.uvs[v] : Vec2{};
    keys.push_back({welded[v], bits(n.x), bits(n.y), bits(n.z), bits(uv.x), bits(uv.y),
                    colors.empty() ? 0 : colors[v]});
  }
  const std::vector<std::uint32_t> first = first_equal<7>(keys);

  Mesh mesh;
  mesh.triangles.resize(source.triangles.size());
  std::vector<std::uint32_t> vertex_of(corners);
  for (std::size_t c = 0; c < corners; ++c) {
    if (first[c] == c) {
      vertex_of[c] = static_cast<std::uint32_t>(mesh.positions.size());
      const std::uint32_t v = source.triangles[c / 3][c % 3];
      mesh.positions.push_back(placed[v]);
      mesh.normals.push_back(rounded(corner_normals[c]));
      if (has_uvs) mesh.uvs.push_back(source.uvs[v]);
      if (!colors.empty()) mesh.colors.push_back(source.colors[v]);
    }
    mesh.triangles[c / 3][c % 3] = vertex_of[first[c]];
  }
  mesh.materials = source.materials;
  return mesh;
}

Mesh with_stored_normals(const FileMesh& source, std::vector<Vec3> placed,
                         const NormaliseOptions& options) {
  if (source.normals.empty())
    fail(ErrorKind::asset, "the model has no normals to keep: \"smooth\" or \"flat\" makes them");
  Mesh mesh;
  mesh.positions = std::move(placed);
  mesh.normals.reserve(source.normals.size());
  const Turner turn(options);
  for (const Vec3 n : source.normals)
    mesh.normals.push_back(rounded(turn(turned(to_double(n), options.up))));
  mesh.uvs = source.uvs;
  mesh.colors = source.colors;
  mesh.triangles = source.triangles;
  mesh.materials = source.materials;
  return mesh;
}

std::vector<Vec3d> flat_corner_normals(const std::vector<Vec3d>& positions,
                                       const std::vector<Triangle>& triangles) {
  std::vector<Vec3d> corners;
  corners.reserve(3 * triangles.size());
  for (const Vec3d normal : face_normals(positions, triangles))
    corners.insert(corners.end(), 3, normal);
  return corners;
}

}  // namespace

bool turns(const NormaliseOptions& options) {
  const auto [w, x, y, z] = options.turn;
  return x != 0 || y != 0 || z != 0;
}

bool tilts(const NormaliseOptions& options) {
  return options.turn[1] != 0 || options.turn[2] != 0;
}

Mesh normalise(const FileMesh& mesh, const NormaliseOptions& options) {
  DS_ASSERT(!mesh.triangles.empty());
  DS_ASSERT(std::isfinite(options.size_m) && options.size_m >= 0);
  DS_ASSERT(std::isfinite(options.ground_z_m));
  DS_ASSERT(options.crease_deg >= 0 && options.crease_deg <= 180);
  std::vector<Vec3d> positions = turned_positions(mesh, options.up);
  std::vector<Vec3> placed = placed_positions(positions, mesh.triangles, options);
  check_digits(placed);
  if (options.normals == Normals::keep)
    return with_stored_normals(mesh, std::move(placed), options);
  // Normals come from the file's coordinates, which rounding has not touched yet.
  const std::vector<std::uint32_t> welded = weld(mesh.positions);
  return with_corner_normals(
      mesh, placed, welded,
      options.normals == Normals::flat
          ? flat_corner_normals(positions, mesh.triangles)
          : smooth_corner_normals(positions, mesh.triangles, welded, options.crease_deg));
}

Box bounds_of(const FileMesh& mesh) {
  return bounds(mesh.positions);
}

Box bounds_of(const Mesh& mesh) {
  return bounds(mesh.positions);
}

MeshExtent extent_of(const FileMesh& mesh) {
  return extent_of(mesh.positions, mesh.triangles);
}

double lowest_of(const FileMesh& mesh, const NormaliseOptions& options) {
  const Turner turn(options);
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3d p : mesh.positions)
    lowest = std::min(lowest, turn(turned(p, options.up)).z);
  return lowest;
}

Mat4 model_to_world(const MeshExtent& file, const NormaliseOptions& options, double lowest) {
  const MeshExtent mesh = turned(file, options.up);
  const double scale = scale_of(mesh.box, options);
  const Vec3d move = ground_of(options) - centre_of_upright(mesh, options, lowest) * scale;
  const Turner turn(options);
  Mat4 matrix;
  const std::array axes{turn(turned(Vec3d{1, 0, 0}, options.up)),
                        turn(turned(Vec3d{0, 1, 0}, options.up)),
                        turn(turned(Vec3d{0, 0, 1}, options.up))};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      matrix.m[4 * row + column] = scale * axes[column][static_cast<int>(row)];
    matrix.m[4 * row + 3] = move[static_cast<int>(row)];
  }
  return matrix;
}

Box normalised_box(const MeshExtent& file, const NormaliseOptions& options, double lowest) {
  const MeshExtent mesh = turned(file, options.up);
  const double scale = scale_of(mesh.box, options);
  const Vec3d centre = centre_of_upright(mesh, options, lowest), ground = ground_of(options);
  if (!turns(options))
    return {(mesh.box.least - centre) * scale + ground, (mesh.box.most - centre) * scale + ground};
  const Turner turn(options);
  std::vector<Vec3d> corners;
  for (const double x : {mesh.box.least.x, mesh.box.most.x})
    for (const double y : {mesh.box.least.y, mesh.box.most.y})
      for (const double z : {mesh.box.least.z, mesh.box.most.z})
        corners.push_back((turn({x, y, z}) - centre) * scale + ground);
  return bounds(corners);
}

}  // namespace ds

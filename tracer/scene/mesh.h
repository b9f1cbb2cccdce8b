// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tracer/base/hash.h"
#include "tracer/base/vec.h"

namespace ds {

/// An indexed triangle mesh. `normals` and `uvs` are empty or as long as `positions`. Positions are finite; every
/// index is below positions.size(). Counter-clockwise seen from outside, where the source says so.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit length, or zero where none can be told
  std::vector<Vec2> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What a reader and `mend` found in one model. Counts are of the file as read, before anything was removed.
struct MeshReport {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;           ///< after triangulation, before removal
  std::uint64_t n_gons = 0;              ///< faces of more than three corners
  std::uint64_t zero_area = 0;           ///< triangles removed: no area
  std::uint64_t duplicate_faces = 0;     ///< triangles removed: same three corners as an earlier one
  std::uint64_t non_finite = 0;          ///< vertices with a NaN, infinite or absurdly far coordinate; their faces are removed
  std::uint64_t out_of_range = 0;        ///< faces removed: an index at or above the vertex count
  std::uint64_t unreferenced = 0;        ///< vertices no triangle uses, removed
  std::uint64_t flipped = 0;             ///< triangles wound against their component's majority (reported, not changed)
  bool has_normals = false;
  bool has_uvs = false;
  std::uint64_t triangles_kept = 0;
};

/// A mesh as its file describes it, before normalisation.
struct Model {
  Mesh mesh;
  MeshReport report;
};

/// Reads PLY or OFF by the file's first bytes (not its name), triangulates, and mends what is listed in MeshReport.
/// Throws Error(asset) with path and line (text) or byte offset (binary) for a file that is cut off, contradicts
/// itself, or leaves no triangle. Never reserves memory on the word of a header alone.
Model read_model(const std::filesystem::path& file);

enum class UpAxis { y, z };
enum class Centring { none, mass, box };  ///< mass: area-weighted centroid of the surface
enum class Normals { smooth, keep, flat };

/// The thesis's normalisation; each step can be switched off. Lengths in metres.
struct NormaliseOptions {
  UpAxis up = UpAxis::y;              ///< y: (x, y, z) -> (x, -z, y), a rotation by +90 degrees about x
  double size_m = 0.16;               ///< longest side of the bounding box; 0: keep the size
  bool place_on_ground = true;        ///< move so that the least z is ground_z_m
  double ground_z_m = -0.0574;
  Centring centre = Centring::mass;   ///< of x and y
  Normals normals = Normals::smooth;  ///< smooth: area-and-angle-weighted, split at creases
  double crease_deg = 60.0;           ///< faces that meet at a larger angle keep an edge
};

/// Arithmetic in double, results rounded once to float. Same bits everywhere.
Mesh normalise(const Mesh& mesh, const NormaliseOptions& options);

/// Hash of positions, normals, uvs and triangles: what a re-saved file keeps. Two files of the same geometry in
/// different formats, headers, comments, number spellings of equal floats, have the same hash.
Hash128 geometry_hash(const Mesh& mesh);

}  // namespace ds

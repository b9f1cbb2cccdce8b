// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"
#include "tracer/base/vec.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// Red, green, blue and alpha, from 0 to 1 and linear, as LuxCore takes them.
using MeshColor = std::array<float, 4>;

/// An indexed triangle mesh. `normals`, `uvs` and `colors` are empty or as long as `positions`. Positions are
/// finite; every index is below positions.size(). Counter-clockwise seen from outside, where the
/// source says so.
template <typename Position>
struct BasicMesh {
  std::vector<Position> positions;
  std::vector<Vec3> normals;  ///< unit length, or zero where none can be told
  std::vector<Vec2> uvs;
  std::vector<MeshColor> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Which of its file's materials each triangle has, by number from 1 in the order in which faces first name
  /// them; 0: none. Empty where none has one; else as long as `triangles`.
  std::vector<std::uint32_t> materials{};
};

/// In the world, as it is traced.
using Mesh = BasicMesh<Vec3>;

/// In a file's coordinates, which may lie so far from their origin (a survey's do) that floats
/// could not tell its vertices apart: doubles until what they have in common is taken off. Those of
/// a mesh that floats hold well are floats' values, so that a file is the same mesh however many
/// digits it is saved with.
using FileMesh = BasicMesh<Vec3d>;

/// Each position rounded on its own.
Mesh in_floats(FileMesh mesh);

/// What a mesh may have beside places: what textures may read, and what it is shaded by.
struct MeshExtras {
  bool uvs = false, colors = false, normals = false;
  bool operator==(const MeshExtras&) const = default;
};

/// A coordinate beyond this (in the file's unit) counts as not finite: it is what a damaged file
/// holds, and its square still fits a float.
inline constexpr double k_farthest_coordinate = 1e18;

/// What reading found in one model and what it mended. A triangle is counted as removed once, for
/// the first reason in the order out_of_range, non_finite, zero_area, duplicate_faces.
struct MeshReport {
  std::uint64_t vertices = 0;     ///< in the file
  std::uint64_t faces = 0;        ///< in the file
  std::uint64_t n_gons = 0;       ///< faces of more than three corners
  std::uint64_t short_faces = 0;  ///< faces of fewer than three corners, dropped
  std::uint64_t triangles = 0;    ///< after triangulation (corners - 2 each), before removal
  /// Faces removed: an index below 0 or not below the vertex count.
  std::uint64_t out_of_range = 0;
  std::uint64_t non_finite = 0;  ///< vertices with a NaN, infinite or too far coordinate, removed
                                 ///< with all their faces
  /// Kept vertices whose normal, uv or colour is not finite, or in no list where an index leads; that is
  /// set to 0, of a colour only the components that are not.
  std::uint64_t bad_attributes = 0;
  /// Colours, of vertices or faces as the file has them, with a part below 0, which becomes 0, or
  /// above 1, which stays.
  std::uint64_t negative_colors = 0, bright_colors = 0;
  /// Colours of a file whose red, green and blue, or alpha, use the least 1/255 of their integer
  /// type's range at most: those of another range.
  std::uint64_t dark_colors = 0;
  std::uint64_t zero_normals = 0;  ///< kept vertices whose stored normal has no direction
  /// Properties of a PLY file that are not used: an earlier one means the same, or they lack those
  /// that make them whole.
  std::uint64_t unused_places = 0, unused_normals = 0, unused_uvs = 0, unused_colors = 0;
  /// Corners without a uv, and vertices or faces without a colour, of files in which others have one:
  /// they get 0 0 and white.
  std::uint64_t missing_uvs = 0, missing_colors = 0;
  std::uint64_t unused_materials = 0;   ///< that a file's faces name
  std::uint64_t unused_attributes = 0;  ///< facets with numbers that may be colours
  std::uint64_t unused_elements = 0;    ///< lines, points and curves
  std::uint64_t unused_surfaces = 0;    ///< of other kinds than faces
  std::uint64_t unused_poses = 0;       ///< meshes that are bent by joints or morphed
  std::uint64_t unknown_lines = 0;      ///< that begin with no word of the format
  std::uint64_t zero_area = 0;          ///< triangles removed: no area
  std::uint64_t duplicate_faces = 0;  ///< triangles removed: the same three corner positions as an
                                      ///< earlier one, whatever the order
  /// Vertices no kept triangle uses, removed (non-finite included).
  std::uint64_t unreferenced = 0;
  std::uint64_t flipped = 0;  ///< kept triangles of closed surfaces turned to face outwards (see
                              ///< Winding)
  std::uint64_t against = 0;  ///< kept triangles of open surfaces wound against the majority of
                              ///< theirs; reported, not changed
  std::uint64_t triangles_kept = 0;
  std::uint64_t trailing_bytes = 0;  ///< behind what the header promises, not read
  bool has_normals = false;
  bool has_uvs = false;
  bool has_colors = false;
};

/// The counts of MeshReport with their names, in the order a table should have them. `damage`: what
/// was done about what no whole file holds. `unlikely`: what the count says of a property that whole
/// files have and that is hardly what is meant, which matters to pictures that read it; without a
/// `property` of parts that are not read, which is as it should be, but must be known. Both null for
/// counts that tell of a mesh and change no picture, as triangles without area do not.
struct MeshReportColumn {
  const char* name;
  std::uint64_t MeshReport::*count;
  const char* damage = nullptr;
  const char* unlikely = nullptr;
  bool MeshExtras::*property = nullptr;  ///< that `unlikely` is of
  bool loses_faces = false;              ///< damage that cost faces
};
inline constexpr const char* k_turned_outwards = "flipped";
inline constexpr const char* k_first_property_counts =
    "are properties of the file that are not read: an earlier one means the same (u and s, red and "
    "diffuse_red, vertices' colours and faces'), or one that goes with them is missing";
inline constexpr std::array k_mesh_report_columns{
    MeshReportColumn{"vertices", &MeshReport::vertices},
    MeshReportColumn{"faces", &MeshReport::faces},
    MeshReportColumn{"n_gons", &MeshReport::n_gons},
    MeshReportColumn{"short_faces", &MeshReport::short_faces,
                     "faces of fewer than three corners removed"},
    MeshReportColumn{"triangles", &MeshReport::triangles},
    MeshReportColumn{"out_of_range", &MeshReport::out_of_range,
                     "faces with an index out of range removed", nullptr, nullptr, true},
    MeshReportColumn{"non_finite", &MeshReport::non_finite,
                     "vertices not finite or beyond 1e18 removed with their faces", nullptr,
                     nullptr, true},
    MeshReportColumn{"bad_attributes", &MeshReport::bad_attributes,
                     "normals, uvs or colours not finite or out of range set to 0"},
    MeshReportColumn{"negative_colors", &MeshReport::negative_colors, nullptr,
                     "have parts below 0, which are taken as 0", &MeshExtras::colors},
    MeshReportColumn{
        "bright_colors", &MeshReport::bright_colors, nullptr,
        "have parts above 1, which give back more light than they get: they run from 0 "
        "to 1, or in whole numbers from 0 to 255",
        &MeshExtras::colors},
    MeshReportColumn{
        "dark_colors", &MeshReport::dark_colors, nullptr,
        "are integers that use 1/255 of what their type holds at most, which is nearly "
        "black, or as alpha clear: uchar runs from 0 to 255, ushort to 65535; what runs "
        "from 0 to 1 is float",
        &MeshExtras::colors},
    MeshReportColumn{
        "zero_normals", &MeshReport::zero_normals, nullptr,
        "are of length 0, and faces there flat; models.normals = \"smooth\" or \"flat\" "
        "makes normals",
        &MeshExtras::normals},
    MeshReportColumn{"unused_places", &MeshReport::unused_places,
                     "further properties that mean x, y or z not read"},
    MeshReportColumn{"unused_normals", &MeshReport::unused_normals, nullptr,
                     k_first_property_counts, &MeshExtras::normals},
    MeshReportColumn{"unused_uvs", &MeshReport::unused_uvs, nullptr, k_first_property_counts,
                     &MeshExtras::uvs},
    MeshReportColumn{"unused_colors", &MeshReport::unused_colors, nullptr, k_first_property_counts,
                     &MeshExtras::colors},
    MeshReportColumn{"missing_uvs", &MeshReport::missing_uvs, nullptr,
                     "are missing at corners of files that have some elsewhere: 0 0 is taken there",
                     &MeshExtras::uvs},
    MeshReportColumn{"missing_colors", &MeshReport::missing_colors, nullptr,
                     "are missing in files that have some elsewhere: white is taken there",
                     &MeshExtras::colors},
    MeshReportColumn{
        "unused_materials", &MeshReport::unused_materials, nullptr,
        "have materials in their files, which are not read: what the recipe gives them "
        "is shown, and materials.assign = \"own\" would show theirs"},
    MeshReportColumn{"unused_attributes", &MeshReport::unused_attributes, nullptr,
                     "are attributes of STL facets, into which programs write colours in ways that "
                     "contradict each other, and are not read",
                     &MeshExtras::colors},
    MeshReportColumn{"unused_elements", &MeshReport::unused_elements, nullptr,
                     "are lines, points or curves, which have no surface, and are not read"},
    MeshReportColumn{"unused_surfaces", &MeshReport::unused_surfaces,
                     "surfaces that are not made of faces not read", nullptr, nullptr, true},
    MeshReportColumn{"unused_poses", &MeshReport::unused_poses, nullptr,
                     "are meshes that joints bend or that morph, and are shown as they are stored"},
    MeshReportColumn{"unknown_lines", &MeshReport::unknown_lines,
                     "lines that begin with no word of the format not read"},
    MeshReportColumn{"zero_area", &MeshReport::zero_area},
    MeshReportColumn{"duplicate_faces", &MeshReport::duplicate_faces},
    MeshReportColumn{"unreferenced", &MeshReport::unreferenced},
    MeshReportColumn{k_turned_outwards, &MeshReport::flipped,
                     "triangles of closed surfaces turned to face outwards"},
    MeshReportColumn{"against", &MeshReport::against},
    MeshReportColumn{"triangles_kept", &MeshReport::triangles_kept},
    MeshReportColumn{"trailing_bytes", &MeshReport::trailing_bytes,
                     "bytes behind what the header promises not read"},
};

/// Damage that reading mended, by name and count, in the order of the columns; empty for a whole
/// file.
using MendedDamage = std::vector<std::pair<std::string, std::uint64_t>>;
MendedDamage mended_damage(const MeshReport& report);
/// What of its properties is hardly what is meant, likewise.
MendedDamage unlikely_properties(const MeshReport& report);
/// The column of a name in either; null for none.
const MeshReportColumn* mesh_report_column(std::string_view name);
/// Whether faces were lost for it.
bool loses_faces(const MendedDamage& damage);
/// "faces with an index out of range removed: 2, ...".
std::string to_text(const MendedDamage& damage);

/// Raised when reading makes another mesh or report of some file: what was found out about files
/// before counts no more.
inline constexpr int k_mesh_reader_version = 11;

/// A mesh as its file describes it, before normalisation.
struct Model {
  FileMesh mesh;
  MeshReport report;
};

/// Whether triangles of closed surfaces are turned to face outwards (mesh_outward.h), or run as the
/// file has them.
enum class Winding { outwards, as_stored };

/// Reads a file of any kind there is (mesh_formats.h), whatever its name, triangulates, and mends
/// what is listed in MeshReport. The order of vertices and triangles is the file's. No -0 in the result.
/// Throws Error(asset) with path and line (text) or byte offset (binary) for a file that is cut
/// off, contradicts itself, or leaves no triangle; Error(io) for one that cannot be read. Never
/// reserves memory on the word of a header alone.
Model read_model(const std::filesystem::path& file, Winding winding = Winding::outwards);

/// The files beside a model's own that hold a part of it (a glTF file's buffers): what it is, changes with them. Throws
/// what read_model throws of a file that names others as none may be named.
std::vector<std::filesystem::path> model_parts(const std::filesystem::path& file);
/// By its name: whether there is anything to ask.
bool may_have_parts(const std::filesystem::path& file);

/// The same for a file already in memory; `name` stands for the path in messages, and is that beside which files lie
/// that hold a part of it.
Model parse_model(std::string_view bytes, const std::string& name,
                  Winding winding = Winding::outwards);

/// Turns what faces inwards of a mesh as read_model leaves it; how many triangles.
std::uint64_t turn_outwards(FileMesh& mesh);

enum class UpAxis { y, z };
enum class Centring { none, mass, box };  ///< mass: area-weighted centroid of the surface
enum class Normals { smooth, keep, flat };

/// The thesis's normalisation; each step can be switched off. Lengths in metres.
struct NormaliseOptions {
  UpAxis up = UpAxis::y;        ///< y: (x, y, z) -> (x, -z, y), a rotation by +90 degrees about x
  double size_m = 0.16;         ///< longest side of the bounding box, finite; 0: keep the size
  bool place_on_ground = true;  ///< move so that the least z is ground_z_m
  double ground_z_m = -0.0574;  ///< finite
  Centring centre = Centring::mass;  ///< of x and y, moved to 0
  /// A unit quaternion: w, x, y, z. Turns the mesh when its size is chosen and before it is put on the
  /// ground, about the point that `centre` moves to 0; with z as the file has it about its height 0.
  std::array<double, 4> turn{1, 0, 0, 0};
  std::array<double, 3> place_m{};  ///< added at last, finite
  Normals normals = Normals::smooth;
  double crease_deg = 60.0;  ///< in [0, 180]: faces that meet at a larger angle keep an edge

  bool operator==(const NormaliseOptions&) const = default;
};
/// Whether the turn moves anything, and whether it moves what points up.
bool turns(const NormaliseOptions& options);
bool tilts(const NormaliseOptions& options);

/// Turns, scales, places and shades a mesh of at least one triangle. Arithmetic in double with
/// + - * / and sqrt only, results rounded once to float: the same bits on every machine. No -0.
///
/// Throws Error(asset) for a mesh that is placed so far from the world's origin that floats there
/// lie more than a thousandth of its size apart: for one left at a survey's coordinates, say.
///
/// Normals: `smooth` weights by area times corner angle, joins vertices of equal position, and
/// splits a vertex where faces meet at more than crease_deg or where neighbours are wound against
/// each other; `flat` gives each triangle its own; `keep` turns the stored ones and throws
/// Error(asset) where the mesh has none. uvs and colours are kept by all three. Triangles keep their order and
/// corners.
Mesh normalise(const FileMesh& mesh, const NormaliseOptions& options);

/// Hash of positions, normals, triangles and of those of uvs and colours that are asked for and
/// there, bit by bit and in order: what a re-saved file keeps. Files of one geometry in different
/// formats, headers, comments or spellings of equal numbers have the same hash once read.
Hash128 geometry_hash(const Mesh& mesh, MeshExtras extras = {true, true, true});
/// The same hash where all positions are floats' values.
Hash128 geometry_hash(const FileMesh& mesh, MeshExtras extras = {true, true, true});

/// Of the numbers of its triangles' materials, which no other hash counts; zero where none has one.
template <typename Position>
Hash128 materials_hash(const BasicMesh<Position>& mesh) {
  return mesh.materials.empty() ? Hash128{} : hash_bytes(std::as_bytes(std::span(mesh.materials)));
}

/// The hash of a mesh's places and triangles, and those of the rest: zero where it has none.
struct MeshHashes {
  Hash128 shape, uvs, colors, normals;
  bool operator==(const MeshHashes&) const = default;
};
MeshHashes mesh_hashes(const FileMesh& mesh);

/// The least and the greatest coordinates.
struct Box {
  Vec3d least, most;
  bool operator==(const Box&) const = default;
};
/// Of the triangles' corners, which all vertices are of a mesh that was read. Of none: all 0.
Box bounds_of(const FileMesh& mesh);
Box bounds_of(const Mesh& mesh);

/// What decides where `normalise` places a mesh, in the file's coordinates.
struct MeshExtent {
  Box box;
  Vec3d centroid;  ///< of the surface, weighted by area
  bool operator==(const MeshExtent&) const = default;
};
MeshExtent extent_of(const FileMesh& mesh);
/// The least z of the mesh turned as `normalise` turns it, in the file's unit: what `lowest` below wants
/// where a mesh that tilts is placed on the ground, whose box does not tell it.
double lowest_of(const FileMesh& mesh, const NormaliseOptions& options);
/// Turns, scales and moves a file's coordinates as `normalise` does; its places are these to single
/// floats.
Mat4 model_to_world(const MeshExtent& file, const NormaliseOptions& options, double lowest = 0);
/// The box of the normalised mesh; of one that is turned, that around its turned box.
Box normalised_box(const MeshExtent& file, const NormaliseOptions& options, double lowest = 0);

}  // namespace ds

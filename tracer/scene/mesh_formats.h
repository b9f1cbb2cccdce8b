// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/own_materials.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A kind of mesh file. To add one: NAME_reader.cc, which defines the MeshFormat NAME_format and
/// states the format at its top, and NAME in the list of mesh.cmake. Nothing else knows of it.
struct MeshFormat {
  std::string_view name;     ///< "PLY"
  std::string_view endings;  ///< of its files, in lower case, with blanks between: ".ply"
  std::string_view holds;    ///< what a file may have beside faces, for the reference
  /// Whether a file is of this kind. `bytes` are its own less a byte order mark, `file` is its path: for
  /// kinds whose content does not tell them. Cheap whatever the bytes are, and throws nothing.
  bool (*matches)(std::string_view bytes, const std::string& file);
  /// `name` stands for the path in messages. Throws Error(asset).
  Polygons (*read)(std::string_view bytes, const std::string& name);
  /// The files beside it that a file holds its parts in, as `read` opens them; null for kinds that have none. Throws as
  /// `read` does.
  std::vector<std::filesystem::path> (*parts)(std::string_view bytes,
                                              const std::string& name) = nullptr;
  /// What the faces' materials are (own_materials.h), whose numbers `read` counts likewise, and the files beside it that
  /// these are in. Null for kinds that have none, and for those that have all in one file.
  OwnMaterials (*materials)(std::string_view bytes, const std::string& name) = nullptr;
  std::vector<std::filesystem::path> (*material_files)(std::string_view bytes,
                                                       const std::string& name) = nullptr;
  /// The bytes of image `number` of those that its materials show and the file holds.
  std::string (*embedded_image)(std::string_view bytes, const std::string& name,
                                int number) = nullptr;
};

/// All, in the order in which they are asked whether a file is theirs.
std::span<const MeshFormat* const> mesh_formats();

/// "PLY or OFF".
std::string mesh_format_names();
/// ".ply", ".off".
std::vector<std::string_view> mesh_endings();
/// ".ply or .off", with another last joint where it is given: ".ply and .off".
std::string mesh_endings_text(std::string_view last_joint = " or ");
/// Whether a file has one of the format's, and one of any's.
bool has_ending_of(const MeshFormat& format, const std::filesystem::path& file);
bool has_mesh_ending(const std::filesystem::path& file);

/// Table of the formats, for recipes/README.md.
std::string mesh_format_reference();

}  // namespace ds

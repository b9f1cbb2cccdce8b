// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "tracer/device/plane_types.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What a plan needs of an environment.
struct EnvironmentFacts {
  std::string text;  ///< canonical_environment
  /// What planes see of it, canonical, by what they read (plane_reads).
  std::map<unsigned, std::string> shapes;
  ToneMap tone_map;
  double longest_side_m = 0;  ///< of the box around its objects; 0 where it has none
  bool unphysical = false;    ///< a material of it gives back more light than it gets, or the like
  bool lost_faces = false;    ///< a mesh of it did when it was read
  bool unlikely = false;      ///< something of its files is hardly meant (Scene::unlikely)
  std::uint32_t largest_object_id = 0, largest_material_id = 0;
  bool gain_changes_program = false;  ///< see vary.h
  std::string nodes;                  ///< EnvironmentSource::nodes
  bool dark = false;                  ///< nothing in it gives light
  bool turns = false;                 ///< turned, it is another one, but for what is round
};

/// What of an object a plane reads beside its places: its traits of kernels/plane_traits.h that say
/// so. With k_plane_materials, of meshes also what materials' textures read, whatever that is.
unsigned plane_reads(const PlaneType& plane);

/// 0 where no material has one.
std::uint32_t largest_material_id(const Scene& scene);

/// Canonical text of materials and textures, whatever shines of them.
std::string canonical_colours(const Scene& scene);

EnvironmentFacts facts_of(const Scene& environment, const std::string& nodes = "");

/// A file that an environment was read from, and its stamp; none where there was no such file.
struct SourceFile {
  std::filesystem::path path;
  std::optional<FileStamp> stamp;
};

/// As a text, with what it was read from, for the database; empty where no text can hold it.
std::string to_text(const EnvironmentFacts& facts, const std::vector<SourceFile>& files);
/// Nothing where a file has another stamp now, or is there or gone, and for what is no such text.
std::optional<EnvironmentFacts> facts_from_text(const std::string& text);

/// The files with their stamps; nothing where one may be written yet without a change of its stamp,
/// seen from the moment when reading began, nanoseconds since 1970.
std::optional<std::vector<SourceFile>> settled(const std::vector<std::filesystem::path>& files,
                                               std::int64_t began_ns);

/// Stands for the program that runs, since another one may read files and write texts otherwise: the
/// stamp of its file. Empty where that cannot be told; then nothing of what it read is kept.
std::string running_program();

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"
#include "tracer/scene/properties.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_names.h"
#include "tracer/scene/sdl_parameters.h"
#include "tracer/scene/type_tables.h"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// Complex refractive index of a conductor at three representative bands, red, green and blue.
struct ConductorIndex {
  Vec3 n;
  Vec3 k;
};

/// Emission whose scale is by power, and so by the area of the object that has the material.
struct PowerEmission {
  double radiance_times_area = 0;  ///< W/sr over the colour (1, 1, 1), all other factors applied
  SourcePlace place;
};

/// What the parts of the reader share while one file is read.
struct SdlReader {
  SdlReader(PropertySet set, std::filesystem::path base, Diagnostics& findings)
      : properties(std::move(set)), folder(std::move(base)), diagnostics(findings) {}

  PropertySet properties;
  std::filesystem::path folder;  ///< relative paths start here
  Diagnostics& diagnostics;
  Scene scene;

  std::map<std::string, TextureRef> textures;        ///< constants are folded
  std::map<std::string, ConductorIndex> conductors;  ///< fresnel* textures
  std::map<std::string, std::string>
      unphysical_conductors;             ///< what is to be said where one is used
  std::map<std::string, int> materials;  ///< index into scene.materials
  std::map<std::string, FileMesh> shapes;
  std::map<int, PowerEmission> power_emissions;  ///< by material
  bool environment = false;                      ///< objects and lights may stand in the file
  /// "scene.materials.body": things that a finding stands about. What refers to them is not to
  /// blame, so that one mistake is one finding.
  std::set<std::string> broken;
  std::vector<std::filesystem::path> files;  ///< that properties name
  ContentOf content_of = content_hash;       ///< of images
  /// "scene.materials.body": what an object, a material or a texture refers to.
  std::set<std::string> referred;
  std::set<std::string> missed;  ///< names that were looked for in vain, and said to be so
};

class SdlNode;

/// Says of each property that nobody took why not; `kinds` are those that may stand in the file.
void report_unused(SdlReader& reader, std::span<const SdlKind> kinds, std::string_view what);
/// A finding for each thing without a type whose name looks like that of another, where one of the two
/// is used by nothing ("scene.materials.redplastic.kd" beside "scene.materials.red-plastic.type").
void report_slips(SdlReader& reader, std::span<const SdlKind> kinds);
/// Warns of each thing that nothing uses: it changes no picture. Whether there is one.
bool warn_of_spare(SdlReader& reader, std::span<const SdlKind> kinds);
/// A section whose name is misspelt ("scene.material") is said once and read as what it means.
void mend_section_names(SdlReader& reader);
/// The known property that an unknown one of a thing seems to be meant for; "" where none is.
std::string_view meant_property(const SdlSection& section, const SdlTypeRow* row,
                                std::string_view unknown);

/// The parts of the reader, in LuxCore's order. Each reads its section of reader.properties.
void read_textures(SdlReader& reader);
void read_materials(SdlReader& reader);
void read_shapes(SdlReader& reader);
void read_objects(SdlReader& reader);
void read_lights(SdlReader& reader);
/// One light of the section.
void read_light(SdlReader& reader, const std::string& name);
/// In place of read_objects: those of a scene that was read before, each in the material that now has its
/// material's name.
void put_objects(SdlReader& reader, const Scene& read);
/// film.imagepipeline. Without any step: LuxCore's default, autolinear and gamma 2.2.
ToneMap read_tone_map(SdlReader& reader);

/// The image of an imagemap texture or infinite light (image_parameters); -1 where it is wrong.
int read_image(const SdlNode& node, double gain, ImageUse use);
/// What read_image takes.
std::vector<SdlParameter> image_parameters();
/// A texture that multiplies `ref` by `factor`; a constant stays one.
TextureRef scaled(SdlReader& reader, const std::string& name, const TextureRef& ref, Vec3d factor);
/// The radiance of a black body, LuxCore's `temperature` and `temperature.normalize`: factor on a
/// light's colour.
Vec3d temperature_factor(const SdlNode& node, std::string_view property);
/// What temperature_factor takes.
std::vector<SdlParameter> temperature_parameters(const std::string& property);

}  // namespace ds

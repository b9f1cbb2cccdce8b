// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/scene/properties.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/sdl_names.h"
#include "tracer/scene/type_tables.h"

#include <filesystem>
#include <map>
#include <optional>
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
  std::map<std::string, int> materials;              ///< index into scene.materials
  std::map<std::string, FileMesh> shapes;
  std::map<int, PowerEmission> power_emissions;  ///< by material
  bool environment = false;                      ///< objects and lights may stand in the file
};

/// One named thing of a file ("scene.materials.body") with typed access to its properties. A getter
/// that finds a wrong value adds a finding and returns what it returns for a missing property, so
/// that reading goes on.
class SdlNode {
 public:
  SdlNode(SdlReader& reader, SdlKind kind, std::string name);

  SdlReader& reader() const { return *reader_; }
  const std::string& name() const { return name_; }
  /// "scene.materials.body"
  const std::string& prefix() const { return prefix_; }
  /// The line of the property, or, where there is none, the first line about this thing.
  SourcePlace place(std::string_view property = {}) const;
  bool has(std::string_view property) const;

  /// The value of `type`, or `default_type`.
  std::string type(std::string_view default_type) const;
  /// Says that the type is not supported or unknown, and takes all the thing's properties.
  void refuse_type(std::string_view type) const;

  std::optional<std::string> text(std::string_view property) const;
  std::optional<double> number(std::string_view property) const;
  double number(std::string_view property, double default_value) const;
  bool flag(std::string_view property, bool default_value) const;
  std::optional<std::vector<double>> numbers(std::string_view property, std::size_t count) const;
  Vec3d vector(std::string_view property, Vec3d default_value) const;
  /// Three numbers, not negative.
  Vec3d color(std::string_view property, Vec3d default_value) const;
  /// 16 numbers, column by column, the last row 0 0 0 1 and the determinant not 0; identity where
  /// missing.
  Mat4 matrix(std::string_view property) const;
  std::optional<std::uint32_t> id(std::string_view property) const;
  /// An existing file, by a path relative to the reader's folder.
  std::optional<std::filesystem::path> file(std::string_view property) const;
  /// All values as indices or floats, `multiple` of them at a time.
  std::vector<double> list(std::string_view property, std::size_t multiple) const;

  /// A constant or a texture; nothing where the property is missing or wrong. A colour given for a
  /// scalar (width 1) is taken by its luminance, as LuxCore does.
  std::optional<TextureRef> texture(std::string_view property, int width) const;
  /// All inputs and numbers of a table row.
  void read_row(const NodeType& row, std::vector<TextureRef>& inputs,
                std::vector<float>& values) const;

  template <typename... Args>
  void error(std::string_view property, fmt::format_string<Args...> format, Args&&... args) const {
    reader_->diagnostics.add(place(property), "{}: {}", full_name(property),
                             fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  std::string full_name(std::string_view property) const;
  const Property* use(std::string_view property) const;

  SdlReader* reader_;
  SdlKind kind_;
  std::string name_;
  std::string prefix_;
};

/// A number in C's spelling, whatever the locale, within the range of a float; nothing for any
/// other text.
std::optional<double> parse_sdl_number(std::string_view text);

/// The parts of the reader, in LuxCore's order. Each reads its section of reader.properties.
void read_textures(SdlReader& reader);
void read_materials(SdlReader& reader);
void read_shapes(SdlReader& reader);
void read_objects(SdlReader& reader);
void read_lights(SdlReader& reader);
/// film.imagepipeline. Without any step: LuxCore's default, autolinear and gamma 2.2.
ToneMap read_tone_map(SdlReader& reader);

/// The image of an imagemap texture or infinite light (file, gain, gamma, wrap, filter, channel);
/// -1 where it is wrong.
int read_image(const SdlNode& node, double gain, ImageUse use);
/// A texture that multiplies `ref` by `factor`; a constant stays one.
TextureRef scaled(SdlReader& reader, const std::string& name, const TextureRef& ref, Vec3d factor);
/// The radiance of a black body, LuxCore's `temperature` and `temperature.normalize`: factor on a
/// light's colour.
Vec3d temperature_factor(const SdlNode& node, std::string_view property);

}  // namespace ds

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
  std::set<std::string> missed;  ///< names that were looked for in vain, and said to be so
};

/// One named thing of a file ("scene.materials.body") with typed access to its properties, which are
/// those of its section's table: a getter takes type, default and range from there. A getter that
/// finds a wrong value adds a finding and returns what it returns for a missing property, so that
/// reading goes on.
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

  /// Reads `type`; from then on the thing has the properties of that type too. False, with a
  /// finding, for one that is not supported or unknown; all the thing's properties are taken then.
  bool read_type();
  const std::string& type() const { return row_->name; }

  std::optional<std::string> text(std::string_view property) const;
  /// One of the table's choices; the default where the value is none.
  std::string choice(std::string_view property) const;
  double number(std::string_view property) const;
  bool flag(std::string_view property) const;
  std::array<double, 2> pair(std::string_view property) const;
  Vec3d vector(std::string_view property) const;
  Vec3d color(std::string_view property) const;
  /// 16 numbers, column by column, the last row 0 0 0 1 and the determinant not 0; identity where
  /// missing.
  Mat4 matrix(std::string_view property) const;
  std::uint32_t id(std::string_view property) const;
  /// An existing file, by a path relative to the reader's folder.
  std::optional<std::filesystem::path> file(std::string_view property) const;
  /// All values as indices or floats, `multiple` of them at a time. Nothing where they are wrong,
  /// and none where they are missing.
  std::optional<std::vector<double>> list(std::string_view property, std::size_t multiple) const;

  /// A constant or a texture; nothing where the property is missing or wrong. A colour given for a
  /// scalar is taken by its luminance, as LuxCore does.
  std::optional<TextureRef> texture(std::string_view property) const;
  /// All inputs and numbers of a type's kernel header.
  void read_row(const NodeType& row, std::vector<TextureRef>& inputs,
                std::vector<float>& values) const;

  /// Says that one of the properties must be there, unless a misspelt one seems to be meant for it.
  void miss(std::span<const std::string_view> properties, std::string_view what) const;
  void miss(std::string_view property) const;
  /// Says, once for each, that the thing `found` of another section is not there, with those that
  /// are; nothing where that thing has a finding of its own.
  template <typename Known>
  void miss_reference(std::string_view property, SdlKind kind, const std::string& found,
                      const Known& known) const {
    std::vector<std::string> names;
    for (const auto& [name, value] : known)
      names.push_back(name);
    miss_named(property, kind, found, names);
  }

  template <typename... Args>
  void error(std::string_view property, fmt::format_string<Args...> format, Args&&... args) const {
    reader_->broken.insert(prefix_);
    reader_->diagnostics.add(place(property), "{}: {}", full_name(property),
                             fmt::format(format, std::forward<Args>(args)...));
  }

 private:
  std::string full_name(std::string_view property) const;
  const Property* use(std::string_view property) const;
  const SdlParameter& parameter(std::string_view property) const;
  /// "wanted ..., found ...", with what a misspelt choice may mean.
  void refuse(const SdlParameter& wanted, const Property& found) const;
  std::optional<std::vector<double>> numbers(const SdlParameter& wanted, std::size_t count) const;
  std::vector<double> numbers_or_default(std::string_view property, std::size_t count) const;
  void refuse_type(std::string_view type) const;
  void miss_named(std::string_view property, SdlKind kind, const std::string& found,
                  const std::vector<std::string>& known) const;

  SdlReader* reader_;
  SdlKind kind_;
  std::string name_;
  std::string prefix_;
  const SdlSection* section_;
  const SdlTypeRow* row_ = nullptr;
};

/// Says of each property that nobody took why not; `kinds` are those that may stand in the file.
void report_unused(SdlReader& reader, std::span<const SdlKind> kinds, std::string_view what);
/// A section whose name is misspelt ("scene.material") is said once and read as what it means.
void mend_section_names(SdlReader& reader);
/// The known property that an unknown one of a thing seems to be meant for; "" where none is.
std::string_view meant_property(const SdlSection& section, const SdlTypeRow* row,
                                std::string_view unknown);

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

/// What a reference says of an input's physical range; "" where it has none.
std::string physical_text(const InputLimit& limit);
/// The properties of a type of material or texture that stand in its kernel header.
std::vector<SdlParameter> header_parameters(const NodeType& type);
/// The lists, one behind the other.
std::vector<SdlParameter> concatenated(std::vector<std::vector<SdlParameter>> lists);

}  // namespace ds

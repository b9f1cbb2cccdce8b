// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/scene/sdl_reader.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

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

  /// That this refers to a thing by its name, which is then used by something.
  void refer(SdlKind kind, const std::string& name) const;

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

}  // namespace ds

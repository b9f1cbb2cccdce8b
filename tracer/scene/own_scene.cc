// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/own_materials.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <system_error>

namespace ds {
namespace {

const NodeType& row_of(std::span<const NodeType> types, int type) {
  return types[static_cast<std::size_t>(type)];
}

/// What a row has where nothing is said.
template <typename Node>
void set_defaults(Node& node, const NodeType& row) {
  for (const InputType& input : row.inputs)
    node.inputs.push_back({{input.default_value, input.default_value, input.default_value}, -1});
  for (const NumberType& number : row.numbers)
    node.numbers.push_back(number.default_value);
}

class SceneBuilder {
 public:
  SceneBuilder(const OwnMaterials& own, bool has_colors, const ContentOf& content_of)
      : own_(own), has_colors_(has_colors), content_of_(content_of) {}

  Scene build() {
    for (const OwnMaterial& material : own_.materials)
      add(material, static_cast<std::uint32_t>(scene_.materials.size() + 1));
    const auto count = static_cast<int>(own_.materials.size());
    scene_.own_materials.push_back(own_.has_bare ? count : -1);
    for (int i = 0; i < count; ++i)
      scene_.own_materials.push_back(i);
    if (own_.has_bare) add(bare(), 0);
    scene_.own_faces = own_.faces;
    return std::move(scene_);
  }

 private:
  /// Colours stand for the grey that is there for want of any.
  OwnMaterial bare() const {
    OwnMaterial shown = own_.bare;
    if (has_colors_ && shown == light_grey()) shown.inputs["basecolor"].factor = {1, 1, 1};
    return shown;
  }

  void add(const OwnMaterial& material, std::uint32_t id) {
    Material made;
    made.name = fmt::format("own{}", id);
    made.type = find_type(material_types(), "disney");
    made.id = id;
    const NodeType& row = row_of(material_types(), made.type);
    set_defaults(made, row);
    for (const auto& [name, input] : material.inputs) {
      const int at = find_input(row, name);
      DS_ASSERT(at >= 0);
      TextureRef value = value_of(input, made.name + "." + name, material.name);
      if (name == "basecolor" && has_colors_) value = times_colors(value, made.name);
      made.inputs[static_cast<std::size_t>(at)] = value;
    }
    scene_.materials.push_back(std::move(made));
  }

  Texture texture_of(std::string_view type, std::string name) const {
    Texture texture;
    texture.name = std::move(name);
    texture.type = find_type(texture_types(), type);
    DS_ASSERT(texture.type >= 0);
    set_defaults(texture, row_of(texture_types(), texture.type));
    return texture;
  }

  TextureRef put(Texture texture) {
    scene_.textures.push_back(std::move(texture));
    return {{}, static_cast<int>(scene_.textures.size()) - 1};
  }

  TextureRef product(TextureRef a, TextureRef b, std::string name) {
    Texture scale = texture_of("scale", std::move(name));
    scale.inputs = {a, b};
    return put(std::move(scale));
  }

  TextureRef value_of(const OwnInput& input, const std::string& name, const std::string& of) {
    if (input.image < 0) return {input.factor, -1};
    Texture map = texture_of("imagemap", name);
    map.image = image_of(input, of);
    std::copy(input.uv_transform.begin(), input.uv_transform.end(), std::begin(map.uv_transform));
    const TextureRef shown = put(std::move(map));
    if (input.factor == Vec3{1, 1, 1}) return shown;
    return product(shown, {input.factor, -1}, name + ".factor");
  }

  TextureRef times_colors(TextureRef value, const std::string& name) {
    const TextureRef colors = put(texture_of("hitpointcolor", name + ".colors"));
    if (value.texture < 0 && value.constant == Vec3{1, 1, 1}) return colors;
    return product(value, colors, name + ".basecolor.colors");
  }

  int image_of(const OwnInput& input, const std::string& of) {
    const OwnImage& own = own_.images.at(static_cast<std::size_t>(input.image));
    Image image;
    image.file = own.file;
    image.embedded = own.embedded;
    image.channel = input.channel;
    image.srgb = input.srgb;
    image.gamma = 1;
    image.wrap = input.wrap;
    image.filter = input.filter;
    image.content = own.embedded >= 0 ? own.content : content_of_file(own.file, of);
    const auto same = [&](const Image& other) {
      return other.file == image.file && other.embedded == image.embedded &&
             other.channel == image.channel && other.srgb == image.srgb &&
             other.wrap == image.wrap && other.filter == image.filter;
    };
    const auto at = std::find_if(scene_.images.begin(), scene_.images.end(), same);
    const auto index = static_cast<int>(at - scene_.images.begin());
    if (at == scene_.images.end()) scene_.images.push_back(std::move(image));
    return index;
  }

  Hash128 content_of_file(const std::filesystem::path& file, const std::string& of) const {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
      fail(ErrorKind::asset, "{}: wanted an image that the material \"{}\" shows, found no file",
           file.string(), of);
    return content_of_(file);
  }

  const OwnMaterials& own_;
  bool has_colors_;
  const ContentOf& content_of_;
  Scene scene_;
};

}  // namespace

Scene own_scene(const OwnMaterials& materials, bool has_colors, const ContentOf& content_of) {
  return SceneBuilder(materials, has_colors, content_of).build();
}

}  // namespace ds

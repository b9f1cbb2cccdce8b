// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <array>
#include <iterator>
#include <span>

namespace ds {
namespace {

std::string_view word(ImageWrap wrap) {
  switch (wrap) {
    case ImageWrap::repeat:
      return "repeat";
    case ImageWrap::black:
      return "black";
    case ImageWrap::white:
      return "white";
    case ImageWrap::clamp:
      return "clamp";
  }
  return "";
}

std::string_view word(ImageFilter filter) {
  return filter == ImageFilter::nearest ? "nearest" : "linear";
}

std::string_view word(ImageChannel channel) {
  switch (channel) {
    case ImageChannel::rgb:
      return "rgb";
    case ImageChannel::red:
      return "red";
    case ImageChannel::green:
      return "green";
    case ImageChannel::blue:
      return "blue";
    case ImageChannel::alpha:
      return "alpha";
    case ImageChannel::mean:
      return "mean";
    case ImageChannel::colored_mean:
      return "colored_mean";
  }
  return "";
}

std::string_view word(ToneMap::Kind kind) {
  switch (kind) {
    case ToneMap::Kind::linear:
      return "linear";
    case ToneMap::Kind::reinhard02:
      return "reinhard02";
    case ToneMap::Kind::autolinear:
      return "autolinear";
  }
  return "";
}

/// Writes the parts of one scene.
class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  void textures() {
    for (const Texture& texture : scene_.textures)
      write(texture);
  }
  void materials() {
    for (const Material& material : scene_.materials)
      write(material);
  }
  /// Which face has which of a model's own materials.
  void own() {
    if (!scene_.own_materials.empty()) text_.add("faces", scene_.own_faces.hex());
  }
  void objects() {
    for (const Object& object : scene_.objects)
      write(object);
  }
  void lights() {
    for (const Light& light : scene_.lights)
      write(light);
  }
  const std::string& text() const { return text_.text(); }

 private:
  template <typename T>
  void add(std::string_view name, const T& value) {
    text_.add(fmt::format("{}.{}", prefix_, name), value);
  }
  void add(std::string_view name, Vec3 v) {
    const std::array<float, 3> values = {v.x, v.y, v.z};
    add(name, std::span<const float>(values));
  }
  void add(std::string_view name, const Mat4& m) { add(name, std::span<const double>(m.m)); }

  void add(std::string_view name, const TextureRef& ref, int width) {
    if (ref.texture >= 0)
      add(name, std::string_view(scene_.textures[static_cast<std::size_t>(ref.texture)].name));
    else if (width == 1)
      add(name, ref.constant.x);
    else
      add(name, ref.constant);
  }

  void add_row(const NodeType& row, const std::vector<TextureRef>& inputs,
               const std::vector<float>& numbers) {
    DS_ASSERT(inputs.size() == row.inputs.size() && numbers.size() == row.numbers.size());
    add("type", row.name);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      add(row.inputs[i].name, inputs[i], row.inputs[i].width);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      add(row.numbers[i].name, numbers[i]);
  }

  void add_image(int index) {
    if (index < 0) return;
    const Image& image = scene_.images[static_cast<std::size_t>(index)];
    if (!image.made_from.empty()) add("image.made_from", std::string_view(image.made_from));
    add("image.content", std::string_view(image.content.hex()));
    if (image.srgb)
      add("image.transfer", "srgb");
    else
      add("image.gamma", image.gamma);
    add("image.gain", image.gain);
    add("image.wrap", word(image.wrap));
    add("image.filter", word(image.filter));
    add("image.channel", word(image.channel));
  }

  void write(const Texture& texture) {
    prefix_ = "textures." + texture.name;
    add_row(texture_types()[static_cast<std::size_t>(texture.type)], texture.inputs,
            texture.numbers);
    if (texture.world_to_texture != Mat4{}) add("world_to_texture", texture.world_to_texture);
    constexpr std::array<float, 6> k_identity = {1, 0, 0, 0, 1, 0};
    if (!std::equal(k_identity.begin(), k_identity.end(), std::begin(texture.uv_transform)))
      add("uv_transform", std::span<const float>(texture.uv_transform));
    add_image(texture.image);
  }

  void write(const Material& material) {
    prefix_ = "materials." + material.name;
    add_row(material_types()[static_cast<std::size_t>(material.type)], material.inputs,
            material.numbers);
    constexpr std::array<std::string_view, 2> k_children = {"material1", "material2"};
    for (std::size_t i = 0; i < 2; ++i)
      if (material.children[i] >= 0)
        add(k_children[i], std::string_view(material_name(material.children[i])));
    if (material.emits) add("emission", material.emission, 3);
  }

  void write(const Object& object) {
    prefix_ = "objects." + object.name;
    MeshExtras reads = reads_of(scene_, object.material);
    reads.normals = true;
    const Hash128 mesh = geometry_hash(object.mesh, reads);
    add("mesh", std::string_view(mesh.hex()));
    add("material", std::string_view(material_name(object.material)));
    add("camerainvisible", object.camera_invisible);
  }

  void write(const Light& light) {
    prefix_ = "lights." + light.name;
    const LightType& type = type_of(light);
    add("type", type.name);
    for (const LightInput& input : type.host.inputs)
      if (input.value == LightValue::color)
        add(input.name, light.color);
      else if (input.width() == 3)
        add(input.name, light_vector(light, input.name));
      else
        add(input.name, *light_value(light, input.name));
    if ((type.host.made_by & kernels::k_host_panorama) == 0) return;
    add("light_to_world", light.light_to_world);
    add("upper_hemisphere_only", light.upper_hemisphere_only);
    add_image(light.image);
  }

  const std::string& material_name(int index) const {
    return scene_.materials[static_cast<std::size_t>(index)].name;
  }

  const Scene& scene_;
  CanonicalText text_;
  std::string prefix_;
};

}  // namespace

std::string canonical_material(const Scene& material) {
  Writer writer(material);
  writer.textures();
  writer.materials();
  writer.own();
  return writer.text();
}

std::string canonical_environment(const Scene& environment) {
  Writer writer(environment);
  writer.textures();
  writer.materials();
  writer.objects();
  writer.lights();
  return writer.text();
}

std::string canonical_tone_map(const ToneMap& tone_map) {
  CanonicalText text;
  text.add("tone_map.type", word(tone_map.kind));
  if (tone_map.kind == ToneMap::Kind::linear) text.add("tone_map.scale", tone_map.scale);
  if (tone_map.kind == ToneMap::Kind::reinhard02) {
    text.add("tone_map.prescale", tone_map.prescale);
    text.add("tone_map.postscale", tone_map.postscale);
    text.add("tone_map.burn", tone_map.burn);
  }
  text.add("gamma", tone_map.gamma);
  return text.text();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/gltf_file.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_text.h"
#include "tracer/scene/sdl_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

// glTF's metallic and roughness (Khronos' specification of 2.0, section 3.9) as disney's: base colour, metallic and
// roughness, whose squares are alpha in both, are what they are there, and the reflectance of what is no metal is 4 % of
// both (`specular` 0.5). A base colour's texture is sRGB's, roughness is the green and metallic the blue of the other as
// they stand. A material or primitive that says nothing is white, metallic 1 and roughness 1, as the specification has
// it. KHR_texture_transform is applied. The coordinates are TEXCOORD_0's.

namespace ds {
namespace {

class MaterialReader {
 public:
  MaterialReader(const GltfFile& file, const std::string& name) : model_(file.model), name_(name) {}

  OwnMaterials read(const std::vector<int>& used) {
    for (const int material : used)
      own_.materials.push_back(read_one(model_.materials.at(static_cast<std::size_t>(material))));
    own_.bare = of_numbers({1, 1, 1}, 1, 1);
    return std::move(own_);
  }

 private:
  void note(const char* name) { ++own_.notes[name]; }

  /// In [0, 1].
  float share(double value) {
    if (value >= 0 && value <= 1) return static_cast<float>(value) + 0.0F;
    note("out_of_range");
    return value > 1 ? 1.0F : 0.0F;
  }

  static OwnInput grey(float value) { return OwnInput{.factor = {value, value, value}}; }

  static OwnMaterial of_numbers(Vec3 color, float metallic, float roughness) {
    OwnMaterial material;
    material.inputs["basecolor"].factor = color;
    material.inputs["metallic"] = grey(metallic);
    material.inputs["roughness"] = grey(roughness);
    material.inputs["specular"] = grey(0.5F);
    return material;
  }

  OwnMaterial read_one(const tinygltf::Material& from) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const auto part = [&](std::size_t i) {
      return i < pbr.baseColorFactor.size() ? share(pbr.baseColorFactor[i]) : 1.0F;
    };
    OwnMaterial made = of_numbers({part(0), part(1), part(2)}, share(pbr.metallicFactor),
                                  share(pbr.roughnessFactor));
    made.name = from.name;
    add_texture(pbr.baseColorTexture, ImageChannel::rgb, true, made.inputs["basecolor"]);
    add_texture(pbr.metallicRoughnessTexture, ImageChannel::green, false, made.inputs["roughness"]);
    add_texture(pbr.metallicRoughnessTexture, ImageChannel::blue, false, made.inputs["metallic"]);
    note_unused(from);
    return made;
  }

  void note_unused(const tinygltf::Material& from) {
    const bool black = std::all_of(from.emissiveFactor.begin(), from.emissiveFactor.end(),
                                   [](double x) { return x == 0; });
    if (!black) note("emission");
    if (from.alphaMode != "OPAQUE") note("transparency");
    if (from.normalTexture.index >= 0) note("normal_maps");
    if (from.occlusionTexture.index >= 0) note("occlusion_maps");
    const bool further = std::any_of(
        from.extensions.begin(), from.extensions.end(),
        [](const auto& extension) { return extension.first != "KHR_materials_emissive_strength"; });
    if (further) note("extensions");
  }

  void add_texture(const tinygltf::TextureInfo& info, ImageChannel channel, bool srgb,
                   OwnInput& input) {
    if (info.index < 0) return;
    const tinygltf::Texture& texture = at(model_.textures, info.index, "a texture");
    int set = info.texCoord;
    const auto transform = info.extensions.find("KHR_texture_transform");
    if (transform != info.extensions.end() && transform->second.Has("texCoord"))
      set = transform->second.Get("texCoord").GetNumberAsInt();
    if (set != 0) return note("further_uvs");
    const int source = source_of(texture);
    if (source < 0) return note("extensions");
    input.image = image_of(source);
    input.channel = channel;
    input.srgb = srgb;
    if (texture.sampler >= 0)
      read_sampler(at(model_.samplers, texture.sampler, "a sampler"), input);
    if (transform != info.extensions.end()) read_transform(transform->second, input);
  }

  static int source_of(const tinygltf::Texture& texture) {
    if (texture.source >= 0) return texture.source;
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (webp == texture.extensions.end() || !webp->second.Has("source")) return -1;
    return webp->second.Get("source").GetNumberAsInt();
  }

  void read_sampler(const tinygltf::Sampler& sampler, OwnInput& input) {
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) input.filter = ImageFilter::nearest;
    if (sampler.wrapS != sampler.wrapT || sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
      note("mirrored");
    else if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
      input.wrap = ImageWrap::clamp;
  }

  /// The extension's text and examples: scale, then a turn that is counter-clockwise where v runs down, then offset.
  void read_transform(const tinygltf::Value& transform, OwnInput& input) {
    const auto pair = [&](const char* name, double missing) {
      std::array<double, 2> values{missing, missing};
      if (!transform.Has(name)) return values;
      const tinygltf::Value& list = transform.Get(name);
      for (std::size_t i = 0; i < 2 && list.IsArray() && i < list.ArrayLen(); ++i)
        values[i] = list.Get(static_cast<int>(i)).GetNumberAsDouble();
      return values;
    };
    constexpr double k_turn = 2 * portable::k_pi;
    const double turn = transform.Has("rotation")
                            ? std::fmod(transform.Get("rotation").GetNumberAsDouble(), k_turn)
                            : 0;
    const auto scale = pair("scale", 1), offset = pair("offset", 0);
    const double c = std::isfinite(turn) ? portable::cos(turn) : 1,
                 s = std::isfinite(turn) ? portable::sin(turn) : 0;
    const std::array<double, 6> matrix{c * scale[0],  s * scale[1], offset[0],
                                       -s * scale[0], c * scale[1], offset[1]};
    for (std::size_t i = 0; i < matrix.size(); ++i)
      input.uv_transform[i] = to_mesh_float(matrix[i]);
    if (!std::all_of(input.uv_transform.begin(), input.uv_transform.end(),
                     [](float x) { return std::isfinite(x); }))
      fail(ErrorKind::asset, "{}: a KHR_texture_transform is not finite", name_);
  }

  int image_of(int source) {
    const tinygltf::Image& image = at(model_.images, source, "an image");
    if (image.bufferView < 0 && image.image.empty() && !image.uri.empty())
      return image_number(own_, {gltf_file_of_uri(image.uri, name_), -1, {}});
    return image_number(own_, {name_, source, hash_text(gltf_image(model_, source, name_))});
  }

  template <typename T>
  const T& at(const std::vector<T>& list, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      fail(ErrorKind::asset, "{}: wanted {} below {}, found {}", name_, what, list.size(), index);
    return list[static_cast<std::size_t>(index)];
  }

  const tinygltf::Model& model_;
  std::string name_;
  OwnMaterials own_;
};

}  // namespace

std::string_view gltf_image(const tinygltf::Model& model, int number, const std::string& name) {
  const auto none = [&](const char* what) {
    fail(ErrorKind::asset, "{}: image {} is in no {} of the file", name, number, what);
  };
  if (number < 0 || static_cast<std::size_t>(number) >= model.images.size()) none("list");
  const tinygltf::Image& image = model.images[static_cast<std::size_t>(number)];
  const auto text = [](const std::vector<unsigned char>& bytes, std::size_t from,
                       std::size_t size) {
    return std::string_view(reinterpret_cast<const char*>(bytes.data()) + from, size);
  };
  if (image.bufferView < 0) return text(image.image, 0, image.image.size());
  if (static_cast<std::size_t>(image.bufferView) >= model.bufferViews.size()) none("buffer view");
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(image.bufferView)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    none("buffer");
  const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    none("buffer");
  return text(data, view.byteOffset, view.byteLength);
}

OwnMaterials gltf_materials(const GltfFile& file, const std::vector<int>& used,
                            const std::string& name) {
  return MaterialReader(file, name).read(used);
}

}  // namespace ds

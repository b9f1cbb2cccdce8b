// SPDX-License-Identifier: Apache-2.0
#include "tracer/kernels/layout.h"
#include "tracer/scene/fresnel_presets.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_node.h"
#include "tracer/scene/sdl_physical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace ds {
namespace {

TextureRef constant(float value) {
  return {{value, value, value}, -1};
}

/// constfloat1 and constfloat3 become constants where they are used.
void read_constant(const SdlNode& node) {
  const char* name = "value";
  const std::optional<TextureRef> value = node.texture(name);
  if (value && value->texture >= 0) node.error(name, "wanted numbers, found a texture");
  node.reader().textures[node.name()] = value.value_or(constant(1));
}

/// Any constant of one or three numbers, not negative.
Vec3 constant_color(const SdlNode& node, std::string_view property, float default_value) {
  const TextureRef ref = node.texture(property).value_or(constant(default_value));
  if (ref.texture < 0) return ref.constant;
  node.error(property, "a texture is not supported yet here, only a constant");
  return {default_value, default_value, default_value};
}

/// LuxCore's fresnelcolor: both an index and an absorption from each band's kr (P. Shirley's
/// approximations as pbrt v1 has them), so that the reflectance at normal incidence is a little
/// above kr; measured against LuxCore 2.11.
ConductorIndex fresnel_color(Vec3 kr) {
  const auto index = [](float r, float& n, float& k) {
    const double clamped = std::clamp(double{r}, 0.0, 0.999);
    const double root = std::sqrt(clamped);
    n = static_cast<float>((1 + root) / (1 - root));
    k = static_cast<float>(2 * std::sqrt(clamped / (1 - clamped)));
  };
  ConductorIndex result;
  index(kr.x, result.n.x, result.k.x);
  index(kr.y, result.n.y, result.k.y);
  index(kr.z, result.n.z, result.k.z);
  return result;
}

void read_fresnel_preset(const SdlNode& node) {
  node.reader().conductors[node.name()] = *find_conductor_preset(node.choice("name"));
}

/// LuxCore's uvmapping2d: scale, then turn by -rotation degrees, then shift.
void read_mapping_2d(const SdlNode& node, Texture& texture) {
  node.choice("mapping.type");
  node.number("mapping.uvindex");
  const double angle = portable::radians(node.number("mapping.rotation"));
  const std::array<double, 2> scale = node.pair("mapping.uvscale");
  const std::array<double, 2> delta = node.pair("mapping.uvdelta");
  const double c = portable::cos(angle);
  const double s = portable::sin(angle);
  const double m[6] = {c * scale[0], s * scale[1], delta[0], -s * scale[0], c * scale[1], delta[1]};
  std::transform(std::begin(m), std::end(m), std::begin(texture.uv_transform),
                 [](double v) { return static_cast<float>(v); });
}

/// LuxCore's globalmapping3d: `transformation` is applied to the world's point as it stands (not
/// inverted), so a scale of 4 makes a pattern four times as fine.
void read_mapping_3d(const SdlNode& node, Texture& texture) {
  // LuxCore's default is uvmapping3d, which takes (u, v, 0) as the point.
  texture.world_to_texture = node.matrix("mapping.transformation");
  constexpr std::string_view k_type = "mapping.type";
  if (node.has(k_type))
    node.choice(k_type);
  else
    node.miss(std::span(&k_type, 1),
              "mapping.type is missing: only globalmapping3d is supported, and LuxCore takes "
              "uvmapping3d without it");
}

/// Of a texture with a kernel header.
void read_header(const SdlNode& node, Texture& texture) {
  texture.name = node.name();
  texture.type = find_type(texture_types(), node.type());
  DS_ASSERT(texture.type >= 0);
  node.read_row(texture_types()[static_cast<std::size_t>(texture.type)], texture.inputs,
                texture.numbers);
}

void add_texture(const SdlNode& node, Texture texture) {
  SdlReader& reader = node.reader();
  reader.textures[node.name()] = {{}, static_cast<int>(reader.scene.textures.size())};
  reader.scene.textures.push_back(std::move(texture));
}

/// Of any texture with a kernel header, what its traits ask for too.
void read_plain(const SdlNode& node, Texture texture = {}) {
  read_header(node, texture);
  const NodeType& type = texture_types()[static_cast<std::size_t>(texture.type)];
  if (has_trait(type, kernels::k_trait_uv)) read_mapping_2d(node, texture);
  if (has_trait(type, kernels::k_trait_position)) read_mapping_3d(node, texture);
  if (has_trait(type, kernels::k_trait_colors)) node.number("dataindex");
  add_texture(node, std::move(texture));
}

void read_imagemap(const SdlNode& node) {
  Texture texture;
  texture.image = read_image(node, node.number("gain"), ImageUse::texture);
  read_plain(node, std::move(texture));
}

constexpr Parameter k_kr{"kr", "a constant", {.least = 0}, ParameterKind::share};

void read_fresnel_color(const SdlNode& node) {
  const Vec3 kr = constant_color(node, "kr", 0.5f);
  if (auto line = find_unphysical(node, k_kr, {kr, -1}))
    node.reader().unphysical_conductors[node.name()] = std::move(*line);
  node.reader().conductors[node.name()] = fresnel_color(kr);
}

void read_fresnel_const(const SdlNode& node) {
  node.reader().conductors[node.name()] = {constant_color(node, "n", 1),
                                           constant_color(node, "k", 1)};
}

std::vector<SdlParameter> imagemap_parameters() {
  return concatenated(
      {{{"gain", SdlType::number, "1", "factor on the image"}}, image_parameters()});
}

/// What a texture of these traits has beyond its header.
std::vector<SdlParameter> trait_parameters(const NodeType& type) {
  std::vector<SdlParameter> list;
  if (has_trait(type, kernels::k_trait_uv))
    list = {{"mapping.type",
             SdlType::choice,
             "uvmapping2d",
             "how uv coordinates become the image's",
             {},
             {"uvmapping2d"}},
            {"mapping.uvindex",
             SdlType::number,
             "0",
             "there is one set of uv",
             {.least = 0, .most = 0}},
            {"mapping.rotation", SdlType::number, "0", "degrees, after the scale"},
            {"mapping.uvscale", SdlType::pair, "1 1", "factors on u and v"},
            {"mapping.uvdelta", SdlType::pair, "0 0", "added last"}};
  if (has_trait(type, kernels::k_trait_position))
    list = {{"mapping.type",
             SdlType::choice,
             "",
             "the world's coordinates are the texture's; must be given, since LuxCore's default "
             "uvmapping3d is not supported",
             {},
             {"globalmapping3d"}},
            {"mapping.transformation", SdlType::matrix, "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
             "applied to the world's point: a scale of 4 makes a pattern four times as fine"}};
  if (has_trait(type, kernels::k_trait_colors))
    list = {{"dataindex",
             SdlType::number,
             "0",
             "there is one set of colours",
             {.least = 0, .most = 0}}};
  return list;
}

/// How a texture is read that needs more than its kernel header and traits.
struct TextureReader {
  SdlTypeRow row;  ///< the help of those with a kernel header is there
  void (*read)(const SdlNode&);
};

const std::vector<TextureReader>& readers() {
  constexpr NumberRange k_not_negative{.least = 0};
  static const std::vector<TextureReader> table{
      {{"imagemap", "", imagemap_parameters()}, read_imagemap},
      {{"constfloat1", "A number.", {{"value", SdlType::scalar_input, "1", "a constant"}}},
       read_constant},
      {{"constfloat3", "A colour.", {{"value", SdlType::color_input, "1", "a constant"}}},
       read_constant},
      {{"fresnelpreset",
        "A metal's refractive index, for metal2's fresnel.",
        {{"name", SdlType::choice, "aluminium", "which metal", {}, conductor_preset_names()}}},
       read_fresnel_preset},
      {{"fresnelcolor",
        "A metal of about that colour, for metal2's fresnel: LuxCore's n and k of it, with which "
        "0.5 reflects 0.54 at normal incidence.",
        {{std::string(k_kr.name), SdlType::color_input, "0.5", told_text(k_kr), k_kr.range}}},
       read_fresnel_color},
      {{"fresnelconst",
        "A metal's refractive index as numbers, for metal2's fresnel.",
        {{"n", SdlType::color_input, "1", "a constant", k_not_negative},
         {"k", SdlType::color_input, "1", "a constant", k_not_negative}}},
       read_fresnel_const}};
  return table;
}

void read_texture(SdlNode node) {
  if (!node.read_type()) return;
  const auto reader = std::find_if(readers().begin(), readers().end(), [&](const TextureReader& r) {
    return r.row.name == node.type();
  });
  if (reader == readers().end())
    read_plain(node);
  else
    reader->read(node);
}

}  // namespace

const SdlSection& texture_section() {
  static const SdlSection section = [] {
    SdlSection made{SdlKind::texture,
                    "textures",
                    "What a material's inputs may be, by name. A texture's own inputs may be "
                    "textures that stand above it.",
                    "imagemap",
                    {},
                    {}};
    for (const NodeType& type : texture_types())
      made.types.push_back({std::string(type.name), header_comment("textures", type.kernel_prefix),
                            header_parameters(type)});
    for (const TextureReader& reader : readers()) {
      const auto row =
          std::find_if(made.types.begin(), made.types.end(),
                       [&](const SdlTypeRow& known) { return known.name == reader.row.name; });
      if (row == made.types.end())
        made.types.push_back(reader.row);
      else
        row->parameters = concatenated({std::move(row->parameters), reader.row.parameters});
    }
    for (std::size_t i = 0; i < texture_types().size(); ++i)
      made.types[i].parameters =
          concatenated({std::move(made.types[i].parameters), trait_parameters(texture_types()[i])});
    return made;
  }();
  return section;
}

TextureRef scaled(SdlReader& reader, const std::string& name, const TextureRef& ref, Vec3d factor) {
  if (ref.texture < 0) return {to_float(to_double(ref.constant) * factor), -1};
  if (factor == Vec3d{1, 1, 1}) return ref;
  Texture product;
  product.name = name;
  product.type = find_type(texture_types(), "scale");
  DS_ASSERT(product.type >= 0);
  product.inputs = {ref, TextureRef{to_float(factor), -1}};
  reader.scene.textures.push_back(std::move(product));
  return {{}, static_cast<int>(reader.scene.textures.size()) - 1};
}

void read_textures(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.textures"))
    read_texture(SdlNode(reader, SdlKind::texture, name));
}

}  // namespace ds

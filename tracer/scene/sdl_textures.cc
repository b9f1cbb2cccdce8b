// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/hash.h"
#include "tracer/scene/fresnel_presets.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_reader.h"

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
void read_constant(const SdlNode& node, int count) {
  const char* name = "value";
  const std::optional<TextureRef> value = node.texture(name, count);
  if (value && value->texture >= 0) node.error(name, "wanted numbers, found a texture");
  node.reader().textures[node.name()] = value.value_or(constant(1));
}

/// Any constant of one or three numbers, not negative.
Vec3 constant_color(const SdlNode& node, std::string_view property, float default_value) {
  const TextureRef ref = node.texture(property, 3).value_or(constant(default_value));
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
  const std::string name = node.text("name").value_or("aluminium");
  if (const ConductorIndex* preset = find_conductor_preset(name))
    node.reader().conductors[node.name()] = *preset;
  else
    node.error("name", "wanted one of {}, found \"{}\"", conductor_preset_names(), name);
}

/// LuxCore's uvmapping2d: scale, then turn by -rotation degrees, then shift.
void read_mapping_2d(const SdlNode& node, Texture& texture) {
  const std::string type = node.text("mapping.type").value_or("uvmapping2d");
  if (type != "uvmapping2d")
    node.error("mapping.type", "mapping \"{}\" is not supported yet for a 2D texture", type);
  if (node.number("mapping.uvindex", 0) != 0)
    node.error("mapping.uvindex", "a second set of uv coordinates is not supported yet");
  const double angle = portable::radians(node.number("mapping.rotation", 0));
  const std::vector<double> scale =
      node.numbers("mapping.uvscale", 2).value_or(std::vector{1.0, 1.0});
  const std::vector<double> delta =
      node.numbers("mapping.uvdelta", 2).value_or(std::vector{0.0, 0.0});
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
  const std::string type = node.text("mapping.type").value_or("uvmapping3d");
  texture.world_to_texture = node.matrix("mapping.transformation");
  if (type != "globalmapping3d")
    node.error("mapping.type",
               "mapping \"{}\" is not supported yet for a 3D texture, only globalmapping3d is",
               type);
}

void read_table_texture(const SdlNode& node, int type) {
  SdlReader& reader = node.reader();
  const NodeType& row = texture_types()[static_cast<std::size_t>(type)];
  Texture texture;
  texture.name = node.name();
  texture.type = type;
  node.read_row(row, texture.inputs, texture.numbers);
  constexpr std::array<std::string_view, 3> k_3d = {"checkerboard3d", "marble", "fbm"};
  if (row.name == "imagemap") {
    read_mapping_2d(node, texture);
    texture.image = read_image(node, node.number("gain", 1), ImageUse::texture);
  } else if (std::find(k_3d.begin(), k_3d.end(), row.name) != k_3d.end()) {
    read_mapping_3d(node, texture);
  }
  reader.textures[node.name()] = {{}, static_cast<int>(reader.scene.textures.size())};
  reader.scene.textures.push_back(std::move(texture));
}

void read_texture(const SdlNode& node) {
  SdlReader& reader = node.reader();
  const std::string type = node.type("imagemap");
  if (type == "constfloat1") return read_constant(node, 1);
  if (type == "constfloat3") return read_constant(node, 3);
  if (type == "fresnelpreset") return read_fresnel_preset(node);
  if (type == "fresnelcolor") {
    reader.conductors[node.name()] = fresnel_color(constant_color(node, "kr", 0.5f));
    return;
  }
  if (type == "fresnelconst") {
    reader.conductors[node.name()] = {constant_color(node, "n", 1), constant_color(node, "k", 1)};
    return;
  }
  const int row = find_type(texture_types(), type);
  if (row < 0) return node.refuse_type(type);
  read_table_texture(node, row);
}

template <typename Enum>
struct Choice {
  std::string_view name;
  Enum value;
};

template <typename Enum, std::size_t N>
Enum choose(const SdlNode& node, std::string_view property, const Choice<Enum> (&choices)[N]) {
  const std::optional<std::string> text = node.text(property);
  if (!text) return choices[0].value;
  for (const Choice<Enum>& choice : choices)
    if (choice.name == *text) return choice.value;
  std::vector<std::string_view> names;
  for (const Choice<Enum>& choice : choices)
    names.push_back(choice.name);
  node.error(property, "wanted {}, found \"{}\"", fmt::join(names, ", "), *text);
  return choices[0].value;
}

constexpr Choice<ImageWrap> k_wraps[] = {{"repeat", ImageWrap::repeat},
                                         {"black", ImageWrap::black},
                                         {"white", ImageWrap::white},
                                         {"clamp", ImageWrap::clamp}};
constexpr Choice<ImageFilter> k_filters[] = {{"linear", ImageFilter::linear},
                                             {"nearest", ImageFilter::nearest}};
constexpr Choice<ImageChannel> k_channels[] = {
    {"default", ImageChannel::rgb}, {"rgb", ImageChannel::rgb},
    {"red", ImageChannel::red},     {"green", ImageChannel::green},
    {"blue", ImageChannel::blue},   {"alpha", ImageChannel::alpha},
    {"mean", ImageChannel::mean},   {"colored_mean", ImageChannel::colored_mean}};
enum class ColorSpace { luxcore, nop };
constexpr Choice<ColorSpace> k_color_spaces[] = {{"luxcore", ColorSpace::luxcore},
                                                 {"nop", ColorSpace::nop}};
enum class Storage { automatic };
constexpr Choice<Storage> k_storages[] = {{"auto", Storage::automatic},
                                          {"byte", Storage::automatic},
                                          {"half", Storage::automatic},
                                          {"float", Storage::automatic}};

bool is_hdr(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension == ".exr" || extension == ".hdr" || extension == ".pfm";
}

float read_gamma(const SdlNode& node, const std::filesystem::path& file) {
  const double old_name = node.number("gamma", 2.2);
  const double gamma = node.number("colorspace.gamma", old_name);
  if (choose(node, "colorspace", k_color_spaces) == ColorSpace::nop) return 1;
  if (!(gamma > 0)) node.error("gamma", "wanted a number above 0, found {}", gamma);
  // LuxCore raises the linear values of an HDR file to its gamma too, which nobody wants and
  // everybody forgets.
  if (is_hdr(file) && gamma != 1)
    node.error("gamma", "wanted gamma = 1 for the HDR image {}, found {}", file.filename().string(),
               gamma);
  return static_cast<float>(gamma);
}

bool same_reading(const Image& a, const Image& b) {
  return a.file == b.file && a.gamma == b.gamma && a.gain == b.gain && a.wrap == b.wrap &&
         a.filter == b.filter && a.channel == b.channel && a.use == b.use;
}

}  // namespace

int read_image(const SdlNode& node, double gain, ImageUse use) {
  SdlReader& reader = node.reader();
  const std::optional<std::filesystem::path> file = node.file("file");
  if (!file && !node.has("file")) node.error("", "file is missing");
  Image image;
  image.file = file.value_or("");
  image.gain = static_cast<float>(gain);
  image.use = use;
  image.gamma = read_gamma(node, image.file);
  image.wrap = choose(node, "wrap", k_wraps);
  image.filter = choose(node, "filter", k_filters);
  image.channel = choose(node, "channel", k_channels);
  choose(node, "storage", k_storages);
  if (!file) return -1;
  image.content = hash_file(*file).xxh128;
  std::vector<Image>& images = reader.scene.images;
  const auto same = std::find_if(images.begin(), images.end(),
                                 [&](const Image& other) { return same_reading(image, other); });
  if (same != images.end()) return static_cast<int>(same - images.begin());
  images.push_back(std::move(image));
  return static_cast<int>(images.size()) - 1;
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

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/file_names.h"
#include "tracer/base/log.h"
#include "tracer/scene/sdl_node.h"

#include <algorithm>
#include <array>

namespace ds {
namespace {

template <typename Enum>
struct Choice {
  std::string_view name;
  Enum value;
};

template <typename Enum, std::size_t N>
Enum choose(const SdlNode& node, std::string_view property, const Choice<Enum> (&choices)[N]) {
  const std::string wanted = node.choice(property);
  for (const Choice<Enum>& choice : choices)
    if (choice.name == wanted) return choice.value;
  DS_ASSERT(false);
  return choices[0].value;
}

/// The first is the default.
template <typename Enum, std::size_t N>
SdlParameter choice_parameter(std::string name, std::string help,
                              const Choice<Enum> (&choices)[N]) {
  SdlParameter parameter{std::move(name), SdlType::choice, std::string(choices[0].name),
                         std::move(help)};
  for (const Choice<Enum>& choice : choices)
    parameter.choices.push_back(choice.name);
  return parameter;
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
enum class Storage { any };  // LuxCore's; dsbuild keeps floats
constexpr Choice<Storage> k_storages[] = {{"auto", Storage::any},
                                          {"byte", Storage::any},
                                          {"half", Storage::any},
                                          {"float", Storage::any}};

/// An HDR file's values are linear as they stand. LuxCore raises them to the gamma too, which nobody
/// wants: a gamma given for one must be 1.
float read_gamma(const SdlNode& node, const std::filesystem::path& file) {
  const char* name = node.has("colorspace.gamma") ? "colorspace.gamma" : "gamma";
  const double gamma = node.number(name);
  node.number("gamma");
  if (choose(node, "colorspace", k_color_spaces) == ColorSpace::nop) return 1;
  if (!is_named_hdr(file)) return static_cast<float>(gamma);
  if (node.has(name) && gamma != 1)
    node.error(name, "wanted 1 or nothing for the HDR image {}, found {}", file.filename().string(),
               gamma);
  return 1;
}

bool same_reading(const Image& a, const Image& b) {
  return a.file == b.file && a.gamma == b.gamma && a.gain == b.gain && a.wrap == b.wrap &&
         a.filter == b.filter && a.channel == b.channel && a.use == b.use;
}

}  // namespace

std::vector<SdlParameter> image_parameters() {
  constexpr NumberRange k_positive{.least = 0, .open_least = true};
  return {
      {"file", SdlType::file, "",
       "the image; must be given. Colours that a file holds multiplied by its alpha, as EXR does, "
       "are "
       "divided by it"},
      {"gamma", SdlType::number, "2.2", "old name of colorspace.gamma", k_positive},
      {"colorspace.gamma", SdlType::number, "2.2",
       "values are raised to it; an EXR or HDR file's are linear and need none", k_positive},
      choice_parameter("colorspace", "nop: values are linear, whatever the gamma", k_color_spaces),
      choice_parameter("wrap", "what is outside of the image", k_wraps),
      choice_parameter("filter", "between texels; of light always linear", k_filters),
      choice_parameter("channel", "which of the image's channels are taken", k_channels),
      choice_parameter("storage", "LuxCore's; no effect", k_storages)};
}

int read_image(const SdlNode& node, double gain, ImageUse use) {
  SdlReader& reader = node.reader();
  const std::optional<std::filesystem::path> file = node.file("file");
  if (!file && !node.has("file")) node.miss("file");
  Image image;
  image.file = file.value_or("");
  image.gain = static_cast<float>(gain);
  image.use = use;
  image.gamma = read_gamma(node, image.file);
  image.wrap = choose(node, "wrap", k_wraps);
  image.filter = choose(node, "filter", k_filters);
  if (use == ImageUse::light && image.filter == ImageFilter::nearest)
    warn(fmt::format("{}: filter = nearest has no effect on light: it is interpolated",
                     to_string(node.place("filter"))));
  image.channel = choose(node, "channel", k_channels);
  choose(node, "storage", k_storages);
  if (!file) return -1;
  image.content = reader.content_of(*file);
  std::vector<Image>& images = reader.scene.images;
  const auto same = std::find_if(images.begin(), images.end(),
                                 [&](const Image& other) { return same_reading(image, other); });
  if (same != images.end()) return static_cast<int>(same - images.begin());
  images.push_back(std::move(image));
  return static_cast<int>(images.size()) - 1;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/texture_bounds.h"

#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace ds {
namespace {

using Bounds = std::optional<InputBounds>;
using DS_KERNELS::each_channel;
using DS_KERNELS::greater_of;
using DS_KERNELS::lesser_of;

/// Outer ones too.
Bounds known_bounds(const Scene& scene, const TextureRef& ref, const BoundsOfImage& image) {
  if (ref.texture < 0) return InputBounds{ref.constant, ref.constant};
  const Texture& texture = scene.textures[static_cast<std::size_t>(ref.texture)];
  const NodeOnHost& host = texture_types()[static_cast<std::size_t>(texture.type)].host;
  if (texture.image >= 0) return image(scene.images[static_cast<std::size_t>(texture.image)]);
  if (host.bounds == nullptr) return std::nullopt;  // an image whose file is an error of its own
  std::vector<Bounds> inputs;
  for (const TextureRef& input : texture.inputs)
    inputs.push_back(known_bounds(scene, input, image));
  return host.bounds(inputs, texture.numbers.data());
}

bool holds(const NumberRange& range, Vec3 value) {
  return range.contains(double{value.x}) && range.contains(double{value.y}) &&
         range.contains(double{value.z});
}

std::string text_of(Vec3 value) {
  return value.x == value.y && value.y == value.z
             ? fmt::format("{}", value.x)
             : fmt::format("{} {} {}", value.x, value.y, value.z);
}

std::string found_text(const InputBounds& bounds, const NumberRange& range, bool is_texture) {
  if (!is_texture) return text_of(bounds.low);
  return holds(range, bounds.high) ? "a texture that goes down to " + text_of(bounds.low)
                                   : "a texture that goes up to " + text_of(bounds.high);
}

}  // namespace

Bounds input_bounds(const Scene& scene, const TextureRef& ref, const BoundsOfImage& image) {
  const Bounds bounds = known_bounds(scene, ref, image);
  return bounds && bounds->reached ? bounds : std::nullopt;
}

Bounds bounds_before_reading(const Image& image) {
  std::string ending = image.file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  constexpr std::array<std::string_view, 6> k_whole = {".png", ".jpg", ".jpeg",
                                                       ".bmp", ".tga", ".gif"};
  const bool whole = std::find(k_whole.begin(), k_whole.end(), ending) != k_whole.end();
  const float outside = image.wrap == ImageWrap::white ? 1.0f : 0.0f;
  const float most = whole ? std::max(image.gain, outside) : std::numeric_limits<float>::max();
  return InputBounds{{0, 0, 0}, {most, most, most}};
}

InputBounds bounds_of_pixels(const Image& image) {
  InputBounds bounds;
  const std::size_t values = image.rgb.size();
  for (std::size_t i = 0; i + 2 < values; i += 3) {
    const Vec3 pixel{image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
    bounds.low = i == 0 ? pixel : each_channel(bounds.low, pixel, lesser_of);
    bounds.high = i == 0 ? pixel : each_channel(bounds.high, pixel, greater_of);
  }
  if (image.wrap == ImageWrap::black) bounds.low = each_channel(bounds.low, Vec3{}, lesser_of);
  if (image.wrap == ImageWrap::white)
    bounds.high = each_channel(bounds.high, Vec3{1, 1, 1}, greater_of);
  return bounds;
}

std::optional<std::string> say_unphysical(std::string_view subject, const Parameter& input,
                                          const InputBounds& bounds, bool is_texture) {
  const bool is_share = input.kind == ParameterKind::share;
  const NumberRange range = is_share ? physical_range(input) : input.range;
  if (holds(range, bounds.low) && holds(range, bounds.high)) return std::nullopt;
  const bool gains = is_share && !holds({.most = range.most}, bounds.high);
  return fmt::format("{}: wanted numbers {}, found {}{}", subject, range.text(),
                     found_text(bounds, range, is_texture),
                     gains ? ": it gives back more light than it gets" : "");
}

std::vector<std::string> add_unphysical_of_pixels(Scene& scene, const BoundsOfImage& image) {
  std::vector<std::string> added;
  for (Material& material : scene.materials) {
    const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
    for (const InputOfPixels& input : material.of_pixels) {
      const Parameter& told =
          type.inputs[static_cast<std::size_t>(find_input(type, input.property))].told;
      const Bounds bounds = input_bounds(scene, input.value, image);
      // White that was converted between primaries, or divided by alpha, is 1 but for rounding.
      constexpr float k_rounded = 1 - 1e-4f;
      if (!bounds || !say_unphysical(input.subject, told,
                                     {bounds->low * k_rounded, bounds->high * k_rounded}, true))
        continue;
      if (auto line = say_unphysical(input.subject, told, *bounds, true)) {
        material.unphysical.push_back(*line);
        added.push_back(std::move(*line));
      }
    }
  }
  return added;
}

}  // namespace ds

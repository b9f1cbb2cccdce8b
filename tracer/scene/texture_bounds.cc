// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/texture_bounds.h"

#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

namespace ds {
namespace {

using Bounds = std::optional<InputBounds>;

bool is_constant(const InputBounds& bounds) {
  return bounds.low == bounds.high;
}

template <typename Function>
Vec3 each(Vec3 a, Vec3 b, Function function) {
  return {function(a.x, b.x), function(a.y, b.y), function(a.z, b.z)};
}

float lesser_of(float a, float b) {
  return std::min(a, b);
}
float greater_of(float a, float b) {
  return std::max(a, b);
}

Bounds either(const Bounds& a, const Bounds& b) {
  if (!a || !b) return std::nullopt;
  return InputBounds{each(a->low, b->low, lesser_of), each(a->high, b->high, greater_of)};
}

/// An operation that is monotonic in either operand, of two operands of which one is a constant.
template <typename Operation>
Bounds combined(const Bounds& a, const Bounds& b, Operation operation) {
  if (!a || !b || (!is_constant(*a) && !is_constant(*b))) return std::nullopt;
  const Vec3 one = each(a->low, b->low, operation), other = each(a->high, b->high, operation);
  const Vec3 third = each(a->low, b->high, operation), fourth = each(a->high, b->low, operation);
  return either(either(InputBounds{one, one}, InputBounds{other, other}),
                either(InputBounds{third, third}, InputBounds{fourth, fourth}));
}

/// From `from` to `to` by an amount that is held in [0, 1].
Bounds mixed(const Bounds& amount, const Bounds& from, const Bounds& to) {
  if (!amount || !is_constant(*amount)) return either(from, to);
  const float share = std::clamp(amount->low.x, 0.0f, 1.0f);
  return combined(from, to, [share](float a, float b) { return (1 - share) * a + share * b; });
}

Bounds texture_bounds(const Scene& scene, const Texture& texture, const BoundsOfImage& image) {
  const NodeType& type = texture_types()[static_cast<std::size_t>(texture.type)];
  const auto input = [&](std::string_view name) {
    return input_bounds(scene, texture.inputs[static_cast<std::size_t>(find_input(type, name))],
                        image);
  };
  if (type.name == "imagemap") {
    if (texture.image < 0) return std::nullopt;  // its file is an error of its own
    return image(scene.images[static_cast<std::size_t>(texture.image)]);
  }
  if (reads_colors(type)) return InputBounds{{0, 0, 0}, {1, 1, 1}};
  if (has_trait(type, kernels::k_trait_chooses))
    return either(input("texture1"), input("texture2"));
  if (type.name == "mix") return mixed(input("amount"), input("texture1"), input("texture2"));
  if (type.name == "add") return combined(input("texture1"), input("texture2"), std::plus());
  if (type.name == "subtract") return combined(input("texture1"), input("texture2"), std::minus());
  if (type.name == "scale")
    return combined(input("texture1"), input("texture2"), std::multiplies());
  return std::nullopt;
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
  if (ref.texture < 0) return InputBounds{ref.constant, ref.constant};
  return texture_bounds(scene, scene.textures[static_cast<std::size_t>(ref.texture)], image);
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
    bounds.low = i == 0 ? pixel : each(bounds.low, pixel, lesser_of);
    bounds.high = i == 0 ? pixel : each(bounds.high, pixel, greater_of);
  }
  if (image.wrap == ImageWrap::black) bounds.low = each(bounds.low, Vec3{}, lesser_of);
  if (image.wrap == ImageWrap::white) bounds.high = each(bounds.high, Vec3{1, 1, 1}, greater_of);
  return bounds;
}

std::optional<std::string> say_unphysical(std::string_view subject, std::string_view property,
                                          const InputBounds& bounds, bool is_texture) {
  const InputLimit limit = limit_of(property);
  const bool is_share = !limit.physical.text().empty();
  const NumberRange& range = is_share ? limit.physical : limit.range;
  if (holds(range, bounds.low) && holds(range, bounds.high)) return std::nullopt;
  const bool gains = is_share && !holds({.most = range.most}, bounds.high);
  return fmt::format("{}: wanted numbers {}, found {}{}", subject, range.text(),
                     found_text(bounds, range, is_texture),
                     gains ? ": it gives back more light than it gets" : "");
}

std::vector<std::string> add_unphysical_of_pixels(Scene& scene, const BoundsOfImage& image) {
  std::vector<std::string> added;
  for (Material& material : scene.materials)
    for (const InputOfPixels& input : material.of_pixels) {
      const Bounds bounds = input_bounds(scene, input.value, image);
      // White that was converted between primaries, or divided by alpha, is 1 but for rounding.
      constexpr float k_rounded = 1 - 1e-4f;
      if (!bounds || !say_unphysical(input.subject, input.property,
                                     {bounds->low * k_rounded, bounds->high * k_rounded}, true))
        continue;
      if (auto line = say_unphysical(input.subject, input.property, *bounds, true)) {
        material.unphysical.push_back(*line);
        added.push_back(std::move(*line));
      }
    }
  return added;
}

}  // namespace ds

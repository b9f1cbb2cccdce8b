// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_physical.h"

#include <algorithm>
#include <cmath>

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

Bounds texture_bounds(const Scene& scene, const Texture& texture) {
  const NodeType& type = texture_types()[static_cast<std::size_t>(texture.type)];
  const auto input = [&](std::string_view name) {
    return input_bounds(scene, texture.inputs[static_cast<std::size_t>(find_input(type, name))]);
  };
  if (type.name == "checkerboard3d") return either(input("texture1"), input("texture2"));
  if (type.name == "mix") return mixed(input("amount"), input("texture1"), input("texture2"));
  if (type.name == "add") return combined(input("texture1"), input("texture2"), std::plus());
  if (type.name == "subtract") return combined(input("texture1"), input("texture2"), std::minus());
  if (type.name == "scale")
    return combined(input("texture1"), input("texture2"), std::multiplies());
  return std::nullopt;  // its pixels, or noise, would tell
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

std::optional<InputBounds> input_bounds(const Scene& scene, const TextureRef& ref) {
  if (ref.texture < 0) return InputBounds{ref.constant, ref.constant};
  return texture_bounds(scene, scene.textures[static_cast<std::size_t>(ref.texture)]);
}

std::optional<std::string> find_unphysical(const SdlNode& node, std::string_view property,
                                           const TextureRef& value) {
  const InputLimit limit = limit_of(property);
  const bool is_share = !limit.physical.text().empty();
  const NumberRange& range = is_share ? limit.physical : limit.range;
  const Bounds bounds = input_bounds(node.reader().scene, value);
  if (!bounds || (holds(range, bounds->low) && holds(range, bounds->high))) return std::nullopt;
  const bool gains = is_share && !holds({.most = range.most}, bounds->high);
  return fmt::format("{}: {}.{}: wanted numbers {}, found {}{}", to_string(node.place(property)),
                     node.prefix(), property, range.text(),
                     found_text(*bounds, range, value.texture >= 0),
                     gains ? ": it gives back more light than it gets" : "");
}

std::vector<std::string> find_unphysical(const SdlNode& node, const NodeType& type,
                                         const std::vector<TextureRef>& inputs) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < type.inputs.size(); ++i)
    if (auto line = find_unphysical(node, type.inputs[i].name, inputs[i]))
      found.push_back(std::move(*line));
  return found;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_physical.h"

#include "tracer/scene/texture_bounds.h"

#include <utility>

namespace ds {
namespace {

std::optional<InputBounds> not_read(const Image&) {
  return std::nullopt;
}

std::string subject_of(const SdlNode& node, std::string_view property) {
  return fmt::format("{}: {}.{}", to_string(node.place(property)), node.prefix(), property);
}

}  // namespace

std::optional<std::string> find_unphysical(const SdlNode& node, const Parameter& input,
                                           const TextureRef& value) {
  const auto bounds = input_bounds(node.reader().scene, value, not_read);
  if (!bounds) return std::nullopt;
  return say_unphysical(subject_of(node, input.name), input, *bounds, value.texture >= 0);
}

void find_unphysical(const SdlNode& node, const NodeType& type, Material& material) {
  const Scene& scene = node.reader().scene;
  for (std::size_t i = 0; i < type.inputs.size(); ++i) {
    const Parameter& input = type.inputs[i].told;
    const TextureRef& value = material.inputs[i];
    if (auto line = find_unphysical(node, input, value)) {
      material.unphysical.push_back(std::move(*line));
      continue;
    }
    if (input_bounds(scene, value, not_read)) continue;
    const auto bounds = input_bounds(scene, value, bounds_before_reading);
    std::string subject = subject_of(node, input.name);
    if (bounds && say_unphysical(subject, input, *bounds, true))
      material.of_pixels.push_back({std::move(subject), std::string(input.name), value});
  }
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/vary_material.h"

#include "tracer/base/name_pattern.h"
#include "tracer/scene/type_tables.h"

#include <cstddef>

namespace ds {
namespace {

/// Calls visit(type, node, index of the input or -1, index of the number or -1) for each property.
template <typename Nodes, typename Visit>
void visit_nodes(Nodes& nodes, std::span<const NodeType> types, std::string_view pattern,
                 const Visit& visit) {
  const std::size_t dot = pattern.rfind('.');
  if (dot == pattern.npos) return;
  const std::string_view property = pattern.substr(dot + 1);
  for (auto& node : nodes) {
    if (!fits_pattern(node.name, pattern.substr(0, dot))) continue;
    const NodeType& type = types[static_cast<std::size_t>(node.type)];
    const int input = find_input(type, property), number = find_number(type, property);
    if (input >= 0 || number >= 0) visit(type, node, input, number);
  }
}

template <typename SceneType, typename Visit>
void visit_properties(SceneType& material, std::string_view pattern, const Visit& visit) {
  visit_nodes(material.materials, material_types(), pattern, visit);
  visit_nodes(material.textures, texture_types(), pattern, visit);
}

}  // namespace

PropertyFit fit_of(const Scene& material, std::string_view pattern) {
  PropertyFit fit;
  visit_properties(
      material, pattern, [&](const NodeType& type, const auto&, int input, int number) {
        ++fit.count;
        if (number >= 0) {
          const ParameterKind kind = type.numbers[static_cast<std::size_t>(number)].told.kind;
          fit.flag = fit.flag || kind == ParameterKind::flag || kind == ParameterKind::whole;
        }
        fit.colour =
            fit.colour || (input >= 0 && type.inputs[static_cast<std::size_t>(input)].width == 3);
      });
  return fit;
}

Scene with_values(Scene material, std::span<const PropertyValue> values) {
  for (const PropertyValue& one : values)
    visit_properties(
        material, one.pattern, [&](const NodeType&, auto& node, int input, int number) {
          if (input >= 0)
            node.inputs[static_cast<std::size_t>(input)] = {to_float(one.value), -1};
          else
            node.numbers[static_cast<std::size_t>(number)] = static_cast<float>(one.value.x);
        });
  return material;
}

}  // namespace ds

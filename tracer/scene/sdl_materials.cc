// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/fresnel_presets.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_reader.h"

#include <algorithm>
#include <array>

namespace ds {
namespace {

void set_input(Material& material, std::string_view input, Vec3 value) {
  const NodeType& row = material_types()[static_cast<std::size_t>(material.type)];
  const int index = find_input(row, input);
  DS_ASSERT(index >= 0);
  material.inputs[static_cast<std::size_t>(index)] = {value, -1};
}

/// metal2: the first of preset (or name), fresnel and n, k counts.
void finish_metal2(const SdlNode& node, Material& material) {
  const char* preset_name = node.has("preset") ? "preset" : "name";
  if (const std::optional<std::string> preset = node.text(preset_name)) {
    if (const ConductorIndex* index = find_conductor_preset(*preset)) {
      set_input(material, "n", index->n);
      set_input(material, "k", index->k);
    } else {
      node.error(preset_name, "wanted one of {}, found \"{}\"", conductor_preset_names(), *preset);
    }
    return;
  }
  const std::optional<std::string> fresnel = node.text("fresnel");
  if (!fresnel) return;
  const auto found = node.reader().conductors.find(*fresnel);
  if (found == node.reader().conductors.end()) {
    node.error(
        "fresnel",
        "wanted the name of a fresnelpreset, fresnelcolor or fresnelconst texture, found \"{}\"",
        *fresnel);
    return;
  }
  set_input(material, "n", found->second.n);
  set_input(material, "k", found->second.k);
}

/// glass: the old names of its indices.
void finish_glass(const SdlNode& node, Material& material) {
  constexpr std::array<std::array<std::string_view, 2>, 2> k_old_names = {
      {{"interiorior", "iorinside"}, {"exteriorior", "ioroutside"}}};
  const NodeType& row = material_types()[static_cast<std::size_t>(material.type)];
  for (const auto& [name, old_name] : k_old_names) {
    const std::optional<TextureRef> value = node.texture(old_name, 1);
    if (value && !node.has(name))
      material.inputs[static_cast<std::size_t>(find_input(row, name))] = *value;
  }
}

int child_index(const SdlNode& node, std::string_view property) {
  const std::optional<std::string> name = node.text(property);
  SdlReader& reader = node.reader();
  if (!name) {
    if (!node.has(property)) node.error("", "{} is missing", property);
    return -1;
  }
  const auto found = reader.materials.find(*name);
  if (found == reader.materials.end()) {
    node.error(property, "material \"{}\" is not defined above", *name);
    return -1;
  }
  if (reader.scene.materials[static_cast<std::size_t>(found->second)].emits)
    node.error(property, "a mix of the material \"{}\", which emits light, is not supported yet",
               *name);
  return found->second;
}

void finish_mix(const SdlNode& node, Material& material) {
  material.children[0] = child_index(node, "material1");
  material.children[1] = child_index(node, "material2");
}

struct Finish {
  std::string_view type;
  void (*finish)(const SdlNode&, Material&);
};
/// What some materials need beyond their row in the table.
constexpr Finish k_finishes[] = {
    {"metal2", finish_metal2}, {"glass", finish_glass}, {"mix", finish_mix}};

/// Luminance by which LuxCore divides where a light is normalised; nothing, with a finding, where
/// it is not known.
std::optional<double> emission_luminance(const SdlNode& node, std::string_view property,
                                         const TextureRef& emission) {
  if (emission.texture >= 0) {
    node.error(property, "normalising by the colour of a textured emission is not supported yet");
    return std::nullopt;
  }
  const double y = portable::luminance(to_double(emission.constant));
  if (y > 0) return y;
  node.error(property, "wanted an emission colour above 0 to normalise by");
  return std::nullopt;
}

/// LuxCore: radiance = emission * gain * temperature colour, times power * efficiency / (pi * area
/// [* luminance]) where both are above 0, else divided by the luminance where gain.normalizebycolor
/// says so.
void read_emission(const SdlNode& node, Material& material, int index) {
  SdlReader& reader = node.reader();
  const std::optional<TextureRef> emission = node.texture("emission", 3);
  Vec3d factor = node.color("emission.gain", {1, 1, 1});
  factor = factor * temperature_factor(node, "emission.temperature");
  const double power = node.number("emission.power", 0);
  const char* efficiency_name =
      node.has("emission.efficency") ? "emission.efficency" : "emission.efficiency";
  const double efficiency = node.number(efficiency_name, 0);
  const bool normalize = node.flag("emission.normalizebycolor", true);
  const bool normalize_gain = node.flag("emission.gain.normalizebycolor", false);
  if (power < 0)
    node.error("emission.power", "wanted a number that is not negative, found {}", power);
  if (efficiency < 0)
    node.error(efficiency_name, "wanted a number that is not negative, found {}", efficiency);
  if (!emission) return;
  if (emission->texture < 0 && emission->constant == Vec3{}) return;

  const bool by_power = power > 0 && efficiency > 0;
  const char* cause = by_power ? "emission.power" : "emission.gain.normalizebycolor";
  if (by_power ? normalize : normalize_gain) {
    const std::optional<double> y = emission_luminance(node, cause, *emission);
    factor = factor * (1 / y.value_or(1));
  }
  if (by_power) {
    if (!reader.environment)
      node.error(cause,
                 "needs the area of an object, and a material file has none: use emission.gain");
    reader.power_emissions[index] = {power * efficiency / portable::k_pi, node.place(cause)};
  }
  material.emits = true;
  material.emission = scaled(reader, node.name() + ".emission", *emission, factor);
}

void read_material_node(const SdlNode& node) {
  SdlReader& reader = node.reader();
  const std::string type = node.type("matte");
  Material material;
  material.name = node.name();
  material.type = find_type(material_types(), type);
  if (material.type < 0) return node.refuse_type(type);
  node.read_row(material_types()[static_cast<std::size_t>(material.type)], material.inputs,
                material.numbers);
  for (const Finish& finish : k_finishes)
    if (finish.type == type) finish.finish(node, material);
  const int index = static_cast<int>(reader.scene.materials.size());
  read_emission(node, material, index);
  reader.materials[node.name()] = index;
  reader.scene.materials.push_back(std::move(material));
}

}  // namespace

void read_materials(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.materials"))
    read_material_node(SdlNode(reader, SdlKind::material, name));
}

}  // namespace ds

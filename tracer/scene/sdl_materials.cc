// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/luminance.h"
#include "tracer/scene/fresnel_presets.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_node.h"
#include "tracer/scene/sdl_physical.h"

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
  if (node.has(preset_name)) {
    if (const ConductorIndex* index = find_conductor_preset(node.choice(preset_name))) {
      set_input(material, "n", index->n);
      set_input(material, "k", index->k);
    }
    return;
  }
  const std::optional<std::string> fresnel = node.text("fresnel");
  if (!fresnel) return;
  node.refer(SdlKind::texture, *fresnel);
  const auto found = node.reader().conductors.find(*fresnel);
  if (found == node.reader().conductors.end()) {
    node.miss_reference("fresnel", SdlKind::texture, *fresnel, node.reader().conductors);
    return;
  }
  if (const auto what = node.reader().unphysical_conductors.find(*fresnel);
      what != node.reader().unphysical_conductors.end())
    material.unphysical.push_back(what->second);
  set_input(material, "n", found->second.n);
  set_input(material, "k", found->second.k);
}

/// Of materials with these inputs: their old names.
constexpr std::array<std::array<std::string_view, 2>, 2> k_old_names = {
    {{"interiorior", "iorinside"}, {"exteriorior", "ioroutside"}}};

void read_old_names(const SdlNode& node, Material& material) {
  const NodeType& row = material_types()[static_cast<std::size_t>(material.type)];
  for (const auto& [name, old_name] : k_old_names) {
    const int input = find_input(row, name);
    const std::optional<TextureRef> value =
        input >= 0 ? node.texture(old_name) : std::optional<TextureRef>{};
    if (value && !node.has(name)) material.inputs[static_cast<std::size_t>(input)] = *value;
  }
}

std::vector<SdlParameter> old_name_parameters(const NodeType& type) {
  std::vector<SdlParameter> parameters;
  for (const auto& [name, old_name] : k_old_names)
    if (find_input(type, name) >= 0)
      parameters.push_back(
          {std::string(old_name), SdlType::scalar_input, "", fmt::format("old name of {}", name),
           type.inputs[static_cast<std::size_t>(find_input(type, name))].told.range});
  return parameters;
}

int child_index(const SdlNode& node, std::string_view property) {
  const std::optional<std::string> name = node.text(property);
  SdlReader& reader = node.reader();
  if (!name) {
    if (!node.has(property)) node.miss(property);
    return -1;
  }
  node.refer(SdlKind::material, *name);
  const auto found = reader.materials.find(*name);
  if (found == reader.materials.end()) {
    node.miss_reference(property, SdlKind::material, *name, reader.materials);
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

/// What some materials have beyond their kernel header.
struct Finish {
  std::string_view type;
  std::vector<SdlParameter> parameters;
  void (*finish)(const SdlNode&, Material&);
};

const std::vector<Finish>& finishes() {
  static const std::vector<Finish> table{
      {"metal2",
       {{"preset",
         SdlType::choice,
         "",
         "a metal's n and k; instead of n and k",
         {},
         conductor_preset_names()},
        {"name", SdlType::choice, "", "as preset", {}, conductor_preset_names()},
        {"fresnel", SdlType::text, "",
         "a texture fresnelpreset, fresnelcolor or fresnelconst; instead of n and k"}},
       finish_metal2},
      {"glossy2",
       {{"multibounce", SdlType::flag, "0",
         "no effect: what comes back after several reflections in the coat always counts"}},
       [](const SdlNode& node, Material&) { node.flag("multibounce"); }},
      {"mix",
       {{"material1", SdlType::text, "", "a material defined above; must be given"},
        {"material2", SdlType::text, "", "likewise, with probability amount"}},
       finish_mix}};
  return table;
}

/// Luminance by which LuxCore divides where a light is normalised; nothing, with a finding, where
/// it is 0.
std::optional<double> emission_luminance(const SdlNode& node, std::string_view property,
                                         const TextureRef& emission) {
  const double y = luxcore_luminance(emission.constant);
  if (y > 0) return y;
  node.error(property, "wanted an emission colour above 0 to normalise by");
  return std::nullopt;
}

/// LuxCore: radiance = emission * gain * temperature colour, times power * efficiency / (pi * area
/// [* luminance]) where both are above 0, else divided by the luminance where gain.normalizebycolor
/// says so.
void read_emission(const SdlNode& node, Material& material, int index) {
  SdlReader& reader = node.reader();
  const std::optional<TextureRef> emission = node.texture("emission");
  Vec3d factor = node.color("emission.gain");
  factor = factor * temperature_factor(node, "emission.temperature");
  const double power = node.number("emission.power");
  const char* efficiency_name =
      node.has("emission.efficency") ? "emission.efficency" : "emission.efficiency";
  const double efficiency = node.number(efficiency_name);
  const bool normalize = node.flag("emission.normalizebycolor");
  const bool normalize_gain = node.flag("emission.gain.normalizebycolor");
  if (!emission) return;
  if (emission->texture >= 0) {
    node.error("emission",
               "a texture that emits is not supported yet, wanted a number or a colour, found {}",
               node.text("emission").value_or(""));
    return;
  }
  if (emission->constant == Vec3{}) return;

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

void read_material_node(SdlNode node) {
  SdlReader& reader = node.reader();
  if (!node.read_type()) return;
  const std::string& type = node.type();
  Material material;
  material.name = node.name();
  material.type = find_type(material_types(), type);
  DS_ASSERT(material.type >= 0);
  node.read_row(material_types()[static_cast<std::size_t>(material.type)], material.inputs,
                material.numbers);
  find_unphysical(node, material_types()[static_cast<std::size_t>(material.type)], material);
  material.id = node.id("id");
  read_old_names(node, material);
  for (const Finish& finish : finishes())
    if (finish.type == type) finish.finish(node, material);
  const int index = static_cast<int>(reader.scene.materials.size());
  read_emission(node, material, index);
  reader.materials[node.name()] = index;
  reader.scene.materials.push_back(std::move(material));
}

std::vector<SdlParameter> emission_parameters() {
  constexpr NumberRange k_from_0{.least = 0};
  return concatenated(
      {{{"emission", SdlType::color_input, "0",
         "radiance; what emits is a light. A texture must be a constant", k_from_0},
        {"emission.gain", SdlType::color, "1 1 1", "factor on emission", k_from_0},
        {"emission.gain.normalizebycolor", SdlType::flag, "0",
         "divide by the emission's luminance"}},
       temperature_parameters("emission.temperature"),
       {{"emission.power", SdlType::number, "0",
         "watts of each object; with an efficiency above 0 it replaces the radiance", k_from_0},
        {"emission.efficiency", SdlType::number, "0", "lumens a watt, as LuxCore has it", k_from_0},
        {"emission.efficency", SdlType::number, "0", "LuxCore's misspelling of it", k_from_0},
        {"emission.normalizebycolor", SdlType::flag, "1",
         "power is the same whatever the colour"}}});
}

}  // namespace

const SdlSection& material_section() {
  static const SdlSection section = [] {
    SdlSection made{SdlKind::material,
                    "materials",
                    "A `.mat` file is for the last material in it; others are its parts. What is a "
                    "number or a colour may be a texture, which stands above its use.",
                    "matte",
                    concatenated({emission_parameters(),
                                  {{"id",
                                    SdlType::id,
                                    "0",
                                    "for the plane material_id",
                                    {.least = 0, .most = 4294967295.0}}}}),
                    {}};
    for (const NodeType& type : material_types()) {
      SdlTypeRow row{std::string(type.name), header_comment("materials", type.kernel_prefix),
                     concatenated({header_parameters(type), old_name_parameters(type)})};
      for (const Finish& finish : finishes())
        if (finish.type == type.name)
          row.parameters = concatenated({std::move(row.parameters), finish.parameters});
      made.types.push_back(std::move(row));
    }
    return made;
  }();
  return section;
}

void read_materials(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.materials"))
    read_material_node(SdlNode(reader, SdlKind::material, name));
}

}  // namespace ds

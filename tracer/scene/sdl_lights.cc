// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"

#include "tracer/base/luminance.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/spectrum.h"

#include <algorithm>

namespace ds {
namespace {

constexpr NumberRange k_not_negative{.least = 0};

/// One `type` of a file and the light it becomes.
struct LightReader {
  SdlTypeRow row;
  std::string_view prefix;
  void (*read)(const SdlNode&, const LightProperties&, Light&);
};

bool is_property(const LightInput& input) {
  return !input.default_value.empty();
}

SdlParameter parameter_of(const LightInput& input) {
  const SdlType type = input.value == LightValue::number  ? SdlType::number
                       : input.value == LightValue::color ? SdlType::color
                                                          : SdlType::vector;
  return {std::string(input.name), type, std::string(input.default_value), std::string(input.help),
          input.value == LightValue::color ? k_not_negative : input.range};
}

/// "affine, applied to the points", "applied to direction", "no effect"
std::string transformation_help(const LightType& type) {
  const LightInput* turned = nullptr;
  for (const LightInput& input : type.host.inputs) {
    if (!is_property(input)) continue;
    if (input.value == LightValue::point) return "affine, applied to the points";
    if (input.value == LightValue::direction) turned = &input;
  }
  return turned != nullptr ? fmt::format("applied to {}", turned->name) : "no effect";
}

LightReader reader_of(std::string_view name, std::string_view prefix, const LightReading& reading) {
  const LightType& type = light_type(prefix);
  std::vector<SdlParameter> inputs;
  if (reading.help.empty())
    for (const LightInput& input : type.host.inputs)
      if (is_property(input)) inputs.push_back(parameter_of(input));
  const std::string help =
      reading.transformation_help.empty() ? transformation_help(type) : reading.transformation_help;
  return {
      {std::string(name), reading.help.empty() ? header_comment("lights", prefix) : reading.help,
       concatenated(
           {std::move(inputs),
            reading.parameters,
            {{"transformation", SdlType::matrix, "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1", help}}})},
      prefix,
      reading.read};
}

const std::vector<LightReader>& readers() {
// A light that is all in its table has no function of its own to name.
#define DS_READER(sdl_name, prefix)                                                 \
  reader_of(sdl_name, #prefix, [] {                                                 \
    if constexpr ((kernels::prefix##_on_host.made_by & kernels::k_host_reads) != 0) \
      return prefix##_reading();                                                    \
    else                                                                            \
      return LightReading{};                                                        \
  }()),
#define DS_MADE_READER(sdl_name, prefix) reader_of(#sdl_name, #prefix, sdl_name##_reading()),
  static const std::vector<LightReader> table{DS_SCENE_LIGHTS(DS_READER)
                                                  DS_MADE_LIGHTS(DS_MADE_READER)};
  return table;
}

bool has_parameter(const LightReader& reader, std::string_view name) {
  return std::any_of(reader.row.parameters.begin(), reader.row.parameters.end(),
                     [&](const SdlParameter& one) { return one.name == name; });
}

LightProperties read_inputs(const SdlNode& node, const LightReader& reader, Light& light) {
  LightProperties found;
  found.factor = node.color("gain") * temperature_factor(node, "temperature");
  found.transformation = node.matrix("transformation");
  for (const LightInput& input : type_of(light).host.inputs) {
    const std::string name(input.name);
    if (!has_parameter(reader, name)) continue;
    Vec3d value;
    switch (input.value) {
      case LightValue::color:
        found.color = node.color(name);
        continue;
      case LightValue::point:
        value = found.transformation.point(node.vector(name));
        break;
      case LightValue::direction:
        value = unit_direction(node, name, found.transformation.direction(node.vector(name)));
        break;
      case LightValue::number:
        value.x = node.number(name);
        break;
    }
    found.values.emplace_back(input.name, value);
    if (input.width() == 3)
      set_light_value(light, input.name, to_float(value));
    else
      *light_value(light, input.name) = static_cast<float>(value.x);
  }
  light.color = to_float(found.factor * found.color);
  return found;
}

void read_node(SdlNode node) {
  if (!node.read_type()) return;
  for (const LightReader& reader : readers()) {
    if (reader.row.name != node.type()) continue;
    Light light = make_light(reader.prefix);
    light.name = node.name();
    const LightProperties properties = read_inputs(node, reader, light);
    if (reader.read != nullptr) reader.read(node, properties, light);
    node.reader().scene.lights.push_back(std::move(light));
  }
}

}  // namespace

Vec3d LightProperties::value(std::string_view input) const {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const auto& one) { return one.first == input; });
  DS_ASSERT(found != values.end());
  return found->second;
}

Vec3d lamp_intensity(const SdlNode& node, const LightProperties& properties, double gain_steradians,
                     double power_steradians) {
  const double power = node.number("power");
  const double efficiency = node.number("efficiency");
  const bool normalize = node.flag("normalizebycolor");
  const Vec3d base = properties.factor * properties.color;
  if (!(power > 0 && efficiency > 0)) return base * (1 / gain_steradians);
  const double y = normalize ? luxcore_luminance(properties.color) : 1;
  if (!(y > 0)) {
    node.error("color", "wanted a colour above 0 to normalise by");
    return base;
  }
  return base * (power * efficiency / (power_steradians * y));
}

std::vector<SdlParameter> lamp_parameters() {
  return {{"power", SdlType::number, "0",
           "watts; with an efficiency above 0 it replaces gain * color", k_not_negative},
          {"efficiency", SdlType::number, "0", "lumens a watt, as LuxCore has it", k_not_negative},
          {"normalizebycolor", SdlType::flag, "1", "power is the same whatever the colour"}};
}

Vec3d unit_direction(const SdlNode& node, std::string_view property, Vec3d v) {
  const double l = length(v);
  if (l > 0) return v * (1 / l);
  node.error(property, "wanted a direction, found a vector of length 0");
  return {0, 0, 1};
}

Vec3d sun_direction(const SdlNode& node, const LightProperties& properties) {
  const Vec3d dir = properties.transformation.direction(node.vector("dir"));
  const Vec3d result = unit_direction(node, "dir", dir);
  if (result.z >= 0) return result;
  node.error("dir", "wanted a sun above the horizon, found z = {}", result.z);
  return {0, 0, 1};
}

SdlParameter sun_direction_parameter() {
  return {"dir", SdlType::vector, "0 0 1", "towards the sun, which is not below the horizon"};
}

const SdlSection& light_section() {
  static const SdlSection section = [] {
    SdlSection made{
        SdlKind::light,
        "lights",
        "The lights of an environment, beside objects whose material emits.",
        "sky2",
        concatenated({{{"gain", SdlType::color, "1 1 1", "factor on the light", k_not_negative}},
                      temperature_parameters("temperature")}),
        {}};
    for (const LightReader& reader : readers())
      made.types.push_back(reader.row);
    return made;
  }();
  return section;
}

std::vector<SdlParameter> temperature_parameters(const std::string& property) {
  return {{property,
           SdlType::number,
           "-1",
           "factor of a black body's colour at so many kelvin, 500 to 40000; below 0: none",
           {.most = 40000}},
          {property + ".normalize", SdlType::flag, "0", "its colour only, not its radiance"}};
}

Vec3d temperature_factor(const SdlNode& node, std::string_view property) {
  const double kelvin = node.number(property);
  const bool normalize = node.flag(fmt::format("{}.normalize", property));
  if (kelvin < 0) return {1, 1, 1};
  if (kelvin >= 500 && kelvin <= 40000) return black_body_color(kelvin, normalize);
  node.error(property, "wanted a temperature in [500, 40000] kelvin, found {}", kelvin);
  return {1, 1, 1};
}

void read_light(SdlReader& reader, const std::string& name) {
  read_node(SdlNode(reader, SdlKind::light, name));
}

void read_lights(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.lights"))
    read_light(reader, name);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// For sdl_lights.cc and lights/*.cc between themselves.
#pragma once

#include "tracer/kernels/lists.h"
#include "tracer/scene/sdl_node.h"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// What the table of inputs made of a light's properties. Reading one again would tell what is wrong
/// with it twice.
struct LightProperties {
  Vec3d factor{1, 1, 1};  ///< gain, and the colour of a temperature
  Vec3d color{1, 1, 1};   ///< where it is a property
  Mat4 transformation;
  /// Inputs that are properties: points and directions (unit) with the transformation applied, of a
  /// number x.
  std::vector<std::pair<std::string_view, Vec3d>> values;

  Vec3d value(std::string_view input) const;
};

/// What a light reads besides: its kind's values stand already as the table says, colour times
/// factor among them.
struct LightReading {
  std::string help{};  ///< of a type that becomes a light of another name; else its header's
  std::vector<SdlParameter> parameters{};
  std::string transformation_help{};  ///< "": of the points or directions of the table
  void (*read)(const SdlNode& node, const LightProperties& properties, Light& light) = nullptr;
};

// Of lights with k_host_reads, and of those that become others: in lights/NAME.cc.
#define DS_DECLARE_READING(sdl_name, prefix) LightReading prefix##_reading();
DS_SCENE_LIGHTS(DS_DECLARE_READING)
#undef DS_DECLARE_READING
#define DS_DECLARE_READING(sdl_name, prefix) LightReading sdl_name##_reading();
DS_MADE_LIGHTS(DS_DECLARE_READING)
#undef DS_DECLARE_READING

/// Radiant intensity that LuxCore gives a lamp: `gain_steradians` divides gain * color, and power
/// (in watts, with an efficiency above 0, and 0 is its default) takes the place of that where it is
/// given.
Vec3d lamp_intensity(const SdlNode& node, const LightProperties& properties, double gain_steradians,
                     double power_steradians);
/// What lamp_intensity reads, but the colour.
std::vector<SdlParameter> lamp_parameters();

/// A unit vector; a finding where the property's is too short.
Vec3d unit_direction(const SdlNode& node, std::string_view property, Vec3d v);

/// The direction of a sun or sky: `dir`, unit, not below the horizon.
Vec3d sun_direction(const SdlNode& node, const LightProperties& properties);
SdlParameter sun_direction_parameter();

}  // namespace ds

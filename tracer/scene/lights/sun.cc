// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"
#include "tracer/scene/sun_model.h"

#include <cmath>

namespace ds {
namespace {

/// A larger disc is as bright on the ground: its radiance falls as its area grows.
void read_sun(const SdlNode& node, const LightProperties& properties, Light& light) {
  const Vec3d direction = sun_direction(node, properties);
  const double turbidity = node.number("turbidity");
  const double sin_radius = k_sun_sin_radius * node.number("relsize");
  set_light_value(light, "direction", to_float(direction));
  const auto cos_total = static_cast<float>(std::sqrt((1 - sin_radius) * (1 + sin_radius)));
  *light_value(light, "cos_total") = cos_total;
  // The cosine is so near 1 that its rounding changes the disc's area by up to a percent; the
  // radiance makes up for it.
  const double cosine = double{cos_total};
  const double rounded_area = (1 - cosine) * (1 + cosine);
  const double area_factor = k_sun_sin_radius * k_sun_sin_radius / rounded_area;
  light.color = to_float(properties.factor * sun_radiance(direction, turbidity) * area_factor);
}

}  // namespace

LightReading sun_reading() {
  return {.parameters =
              {sun_direction_parameter(),
               {"turbidity", SdlType::number, "2.2", "haze of the air", {.least = 1, .most = 30}},
               {"relsize",
                SdlType::number,
                "1",
                "the disc's radius over the sun's; its light on the ground stays",
                {.least = 0, .most = 200, .open_least = true}}},
          .transformation_help = "applied to dir",
          .read = read_sun};
}

}  // namespace ds

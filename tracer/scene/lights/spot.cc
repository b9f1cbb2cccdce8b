// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"
#include "tracer/scene/sdl_math.h"

#include <cmath>

namespace ds {
namespace {

void read_spot(const SdlNode& node, const LightProperties& properties, Light& light) {
  const double cone = node.number("coneangle");
  const double delta = node.number("conedeltaangle");
  if (node.has("conedeltaangle") ? delta > cone : cone < delta)
    node.error(node.has("conedeltaangle") ? "conedeltaangle" : "coneangle",
               "wanted conedeltaangle in [0, coneangle], found {} and {}", delta, cone);
  const double cos_total = portable::cos(portable::radians(cone));
  const double cos_falloff = portable::cos(portable::radians(cone - delta));
  const double steradians = 2 * portable::k_pi * (1 - 0.5 * (cos_total + cos_falloff));
  light.color = to_float(lamp_intensity(node, properties, 1, steradians));
  const auto total = static_cast<float>(cos_total);
  *light_value(light, "cos_total") = total;
  // A sharp edge is one unit of the last place wide: the falloff is divided by its width.
  *light_value(light, "cos_falloff") =
      std::fmax(static_cast<float>(cos_falloff), std::nextafter(total, 2.0f));
  const Vec3d axis =
      properties.transformation.point(node.vector("target")) - properties.value("position");
  set_light_value(light, "direction", to_float(unit_direction(node, "target", axis)));
}

}  // namespace

LightReading spot_reading() {
  return {.parameters =
              concatenated({lamp_parameters(),
                            {{"target", SdlType::vector, "0 0 1", "a point on the cone's axis"},
                             {"coneangle",
                              SdlType::number,
                              "30",
                              "half the cone's angle, degrees",
                              {.least = 0, .most = 90, .open_least = true, .open_most = true}},
                             {"conedeltaangle",
                              SdlType::number,
                              "5",
                              "the part of it in which light falls off, degrees; coneangle at most",
                              {.least = 0, .most = 90, .open_most = true}}}}),
          .read = read_spot};
}

}  // namespace ds

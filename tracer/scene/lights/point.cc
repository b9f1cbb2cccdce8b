// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"
#include "tracer/scene/sdl_math.h"

namespace ds {

LightReading point_reading() {
  return {.parameters = lamp_parameters(),
          .read = [](const SdlNode& node, const LightProperties& properties, Light& light) {
            constexpr double k_sphere = 4 * portable::k_pi;
            light.color = to_float(lamp_intensity(node, properties, k_sphere, k_sphere));
          }};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"
#include "tracer/scene/sky_model.h"

namespace ds {
namespace {

/// An infinite light with a picture of its own.
void read_sky2(const SdlNode& node, const LightProperties& properties, Light& light) {
  SkySettings sky;
  sky.sun_direction = sun_direction(node, properties);
  sky.turbidity = node.number("turbidity");
  sky.ground_albedo = node.color("groundalbedo");
  sky.ground_enable = node.flag("ground.enable");
  sky.ground_autoscale = node.flag("ground.autoscale");
  sky.ground_color = node.color("ground.color");
  std::vector<Image>& images = node.reader().scene.images;
  light.image = static_cast<int>(images.size());
  images.push_back(make_sky_image(sky));
}

}  // namespace

LightReading sky2_reading() {
  constexpr NumberRange k_share{.least = 0, .most = 1};
  return {
      .help =
          "A clear sky without the sun's disc: Hosek and Wilkie's formula, by an own fit to 2 % "
          "(root mean square).",
      .parameters =
          {sun_direction_parameter(),
           {"turbidity", SdlType::number, "2.2", "haze of the air", {.least = 1.7, .most = 10}},
           {"groundalbedo", SdlType::color, "0 0 0", "light the ground throws back into the sky",
            k_share},
           {"ground.enable", SdlType::flag, "0",
            "below the horizon the ground's colour, else the sky at the horizon"},
           {"ground.autoscale", SdlType::flag, "1",
            "the ground's colour is times the luminance of the zenith"},
           {"ground.color", SdlType::color, "0.75 0.75 0.75", "the ground's colour", {.least = 0}}},
      .transformation_help = "applied to dir",
      .read = read_sky2};
}

}  // namespace ds

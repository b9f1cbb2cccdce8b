// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/luminance.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_node.h"
#include "tracer/scene/sky_model.h"
#include "tracer/scene/spectrum.h"
#include "tracer/scene/sun_model.h"

#include <cmath>

namespace ds {
namespace {

/// What every light has: gain and the colour of a temperature.
Vec3d common_factor(const SdlNode& node) {
  return node.color("gain") * temperature_factor(node, "temperature");
}

/// Radiant intensity that LuxCore gives a lamp: `gain_steradians` divides gain * color, and power
/// (in watts, with an efficiency above 0, and 0 is its default) takes the place of that where it is
/// given.
Vec3d lamp_intensity(const SdlNode& node, double gain_steradians, double power_steradians) {
  const Vec3d color = node.color("color");
  const double power = node.number("power");
  const double efficiency = node.number("efficiency");
  const bool normalize = node.flag("normalizebycolor");
  const Vec3d base = common_factor(node) * color;
  if (!(power > 0 && efficiency > 0)) return base * (1 / gain_steradians);
  const double y = normalize ? luxcore_luminance(color) : 1;
  if (!(y > 0)) {
    node.error("color", "wanted a colour above 0 to normalise by");
    return base;
  }
  return base * (power * efficiency / (power_steradians * y));
}

/// A unit vector; a finding where the property's is too short.
Vec3d unit(const SdlNode& node, std::string_view property, Vec3d v) {
  const double l = length(v);
  if (l > 0) return v * (1 / l);
  node.error(property, "wanted a direction, found a vector of length 0");
  return {0, 0, 1};
}

void read_point(const SdlNode& node, Light& light) {
  light.kind = LightKind::point;
  light.color = to_float(lamp_intensity(node, 4 * portable::k_pi, 4 * portable::k_pi));
  light.position = to_float(node.matrix("transformation").point(node.vector("position")));
}

void read_spot(const SdlNode& node, Light& light) {
  light.kind = LightKind::spot;
  const double cone = node.number("coneangle");
  const double delta = node.number("conedeltaangle");
  if (node.has("conedeltaangle") ? delta > cone : cone < delta)
    node.error(node.has("conedeltaangle") ? "conedeltaangle" : "coneangle",
               "wanted conedeltaangle in [0, coneangle], found {} and {}", delta, cone);
  const double cos_total = portable::cos(portable::radians(cone));
  const double cos_falloff = portable::cos(portable::radians(cone - delta));
  const double steradians = 2 * portable::k_pi * (1 - 0.5 * (cos_total + cos_falloff));
  light.color = to_float(lamp_intensity(node, 1, steradians));
  light.cos_total = static_cast<float>(cos_total);
  // A sharp edge is one unit of the last place wide: the falloff is divided by its width.
  light.cos_falloff =
      std::fmax(static_cast<float>(cos_falloff), std::nextafter(light.cos_total, 2.0f));
  const Mat4 m = node.matrix("transformation");
  const Vec3d position = m.point(node.vector("position"));
  const Vec3d target = m.point(node.vector("target"));
  light.position = to_float(position);
  light.direction = to_float(unit(node, "target", target - position));
}

/// The direction of a sun or sky: unit, not below the horizon.
Vec3d sun_direction(const SdlNode& node) {
  const Vec3d dir = node.matrix("transformation").direction(node.vector("dir"));
  const Vec3d result = unit(node, "dir", dir);
  if (result.z >= 0) return result;
  node.error("dir", "wanted a sun above the horizon, found z = {}", result.z);
  return {0, 0, 1};
}

/// A larger disc is as bright on the ground: its radiance falls as its area grows.
void read_sun(const SdlNode& node, Light& light) {
  light.kind = LightKind::sun;
  const Vec3d direction = sun_direction(node);
  const double turbidity = node.number("turbidity");
  const double sin_radius = k_sun_sin_radius * node.number("relsize");
  light.direction = to_float(direction);
  light.cos_total = static_cast<float>(std::sqrt((1 - sin_radius) * (1 + sin_radius)));
  // The cosine is so near 1 that its rounding changes the disc's area by up to a percent; the
  // radiance makes up for it.
  const double cosine = double{light.cos_total};
  const double rounded_area = (1 - cosine) * (1 + cosine);
  const double area_factor = k_sun_sin_radius * k_sun_sin_radius / rounded_area;
  light.color = to_float(common_factor(node) * sun_radiance(direction, turbidity) * area_factor);
}

/// The upper 3x3 must be a rotation, mirrored or not: a lat-long picture cannot be sheared or
/// scaled.
Mat4 rotation_of(const SdlNode& node) {
  Mat4 m = node.matrix("transformation");
  m.m[3] = m.m[7] = m.m[11] = 0;
  Mat4 transposed = m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      transposed.m[i * 4 + j] = m.m[j * 4 + i];
  const Mat4 product = m * transposed;
  double error = 0;
  for (std::size_t i = 0; i < 16; ++i)
    error = std::fmax(error, std::fabs(product.m[i] - Mat4{}.m[i]));
  if (error > 1e-4)
    node.error("transformation", "wanted a rotation, found a matrix that scales or shears");
  return m;
}

void read_infinite(const SdlNode& node, Light& light) {
  light.kind = LightKind::infinite;
  light.color = to_float(common_factor(node));
  Mat4 mirror;
  mirror.m[0] = -1;
  light.light_to_world = rotation_of(node) * mirror;
  light.upper_hemisphere_only = node.flag("sampleupperhemisphereonly");
  light.image = read_image(node, 1, ImageUse::light);
}

void read_constant_infinite(const SdlNode& node, Light& light) {
  light.kind = LightKind::constant_infinite;
  light.color = to_float(common_factor(node) * node.color("color"));
  node.matrix("transformation");
}

/// sky2 becomes an infinite light with a picture of its own.
void read_sky(const SdlNode& node, Light& light) {
  light.kind = LightKind::infinite;
  light.color = to_float(common_factor(node));
  SkySettings sky;
  sky.sun_direction = sun_direction(node);
  sky.turbidity = node.number("turbidity");
  sky.ground_albedo = node.color("groundalbedo");
  sky.ground_enable = node.flag("ground.enable");
  sky.ground_autoscale = node.flag("ground.autoscale");
  sky.ground_color = node.color("ground.color");
  std::vector<Image>& images = node.reader().scene.images;
  light.image = static_cast<int>(images.size());
  images.push_back(make_sky_image(sky));
}

constexpr NumberRange k_not_negative{.least = 0};

SdlParameter transformation(std::string help) {
  return {"transformation", SdlType::matrix, "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1", std::move(help)};
}
SdlParameter color() {
  return {"color", SdlType::color, "1 1 1", "colour, times gain", k_not_negative};
}
SdlParameter direction() {
  return {"dir", SdlType::vector, "0 0 1", "towards the sun, which is not below the horizon"};
}

/// What lamp_intensity reads.
std::vector<SdlParameter> lamp_parameters() {
  return {color(),
          {"power", SdlType::number, "0",
           "watts; with an efficiency above 0 it replaces gain * color", k_not_negative},
          {"efficiency", SdlType::number, "0", "lumens a watt, as LuxCore has it", k_not_negative},
          {"normalizebycolor", SdlType::flag, "1", "power is the same whatever the colour"},
          {"position", SdlType::vector, "0 0 0", "metres"},
          transformation("affine, applied to the points")};
}

struct LightReader {
  SdlTypeRow row;
  void (*read)(const SdlNode&, Light&);
};

const std::vector<LightReader>& readers() {
  static const std::vector<LightReader> table{
      {{"point", "A point that shines alike to all sides.", lamp_parameters()}, read_point},
      {{"spot", "A point that shines into a cone.",
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
                        {.least = 0, .most = 90, .open_most = true}}}})},
       read_spot},
      {{"sun",
        "The sun's disc through a clear sky.",
        {direction(),
         {"turbidity", SdlType::number, "2.2", "haze of the air", {.least = 1, .most = 30}},
         {"relsize",
          SdlType::number,
          "1",
          "the disc's radius over the sun's; its light on the ground stays",
          {.least = 0, .most = 200, .open_least = true}},
         transformation("applied to dir")}},
       read_sun},
      {{"sky2",
        "A clear sky without the sun's disc (Hosek and Wilkie).",
        {direction(),
         {"turbidity", SdlType::number, "2.2", "haze of the air", {.least = 1.7, .most = 10}},
         {"groundalbedo",
          SdlType::color,
          "0 0 0",
          "light the ground throws back into the sky",
          {.least = 0, .most = 1}},
         {"ground.enable", SdlType::flag, "0",
          "below the horizon the ground's colour, else the sky at the horizon"},
         {"ground.autoscale", SdlType::flag, "1",
          "the ground's colour is times the luminance of the zenith"},
         {"ground.color", SdlType::color, "0.75 0.75 0.75", "the ground's colour", k_not_negative},
         transformation("applied to dir")}},
       read_sky},
      {{"infinite",
        "A lat-long picture all around: Z up, the zenith in the top row. As in LuxCore it is seen "
        "mirrored from inside; transformation = 1 0 0 0  0 -1 0 0  0 0 1 0  0 0 0 1 turns that "
        "round.",
        concatenated(
            {image_parameters(),
             {{"sampleupperhemisphereonly", SdlType::flag, "0", "no light from below the horizon"},
              transformation("a rotation, mirrored or not")}})},
       read_infinite},
      {{"constantinfinite",
        "The same light from everywhere.",
        {color(), transformation("no effect")}},
       read_constant_infinite}};
  return table;
}

void read_light(SdlNode node) {
  if (!node.read_type()) return;
  for (const LightReader& reader : readers()) {
    if (reader.row.name != node.type()) continue;
    Light light;
    light.name = node.name();
    reader.read(node, light);
    node.reader().scene.lights.push_back(std::move(light));
  }
}

}  // namespace

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

void read_lights(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.lights"))
    read_light(SdlNode(reader, SdlKind::light, name));
}

}  // namespace ds

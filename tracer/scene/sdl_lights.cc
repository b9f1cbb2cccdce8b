// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_reader.h"
#include "tracer/scene/sky_model.h"
#include "tracer/scene/spectrum.h"
#include "tracer/scene/sun_model.h"

#include <cmath>

namespace ds {
namespace {

/// What every light has: gain and the colour of a temperature.
Vec3d common_factor(const SdlNode& node) {
  return node.color("gain", {1, 1, 1}) * temperature_factor(node, "temperature");
}

/// Radiant intensity that LuxCore gives a lamp: `gain_steradians` divides gain * color, and power
/// (in watts, with an efficiency above 0, and 0 is its default) takes the place of that where it is
/// given.
Vec3d lamp_intensity(const SdlNode& node, double gain_steradians, double power_steradians) {
  const Vec3d color = node.color("color", {1, 1, 1});
  const double power = node.number("power", 0);
  const double efficiency = node.number("efficiency", 0);
  const bool normalize = node.flag("normalizebycolor", true);
  if (power < 0) node.error("power", "wanted a number that is not negative, found {}", power);
  if (efficiency < 0)
    node.error("efficiency", "wanted a number that is not negative, found {}", efficiency);
  const Vec3d base = common_factor(node) * color;
  if (!(power > 0 && efficiency > 0)) return base * (1 / gain_steradians);
  const double y = normalize ? portable::luminance(color) : 1;
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
  light.position = to_float(node.matrix("transformation").point(node.vector("position", {})));
}

void read_spot(const SdlNode& node, Light& light) {
  light.kind = LightKind::spot;
  const double cone = node.number("coneangle", 30);
  const double delta = node.number("conedeltaangle", 5);
  if (!(cone > 0 && cone < 90))
    node.error("coneangle", "wanted an angle in (0, 90) degrees, found {}", cone);
  if (!(delta >= 0 && delta <= cone))
    node.error("conedeltaangle", "wanted an angle in [0, coneangle] degrees, found {}", delta);
  const double cos_total = portable::cos(portable::radians(cone));
  const double cos_falloff = portable::cos(portable::radians(cone - delta));
  const double steradians = 2 * portable::k_pi * (1 - 0.5 * (cos_total + cos_falloff));
  light.color = to_float(lamp_intensity(node, 1, steradians));
  light.cos_total = static_cast<float>(cos_total);
  // A sharp edge is one unit of the last place wide: the falloff is divided by its width.
  light.cos_falloff =
      std::fmax(static_cast<float>(cos_falloff), std::nextafter(light.cos_total, 2.0f));
  const Mat4 m = node.matrix("transformation");
  const Vec3d position = m.point(node.vector("position", {}));
  const Vec3d target = m.point(node.vector("target", {0, 0, 1}));
  light.position = to_float(position);
  light.direction = to_float(unit(node, "target", target - position));
}

/// The direction of a sun or sky: unit, not below the horizon.
Vec3d sun_direction(const SdlNode& node) {
  const Vec3d dir = node.matrix("transformation").direction(node.vector("dir", {0, 0, 1}));
  const Vec3d result = unit(node, "dir", dir);
  if (result.z >= 0) return result;
  node.error("dir", "wanted a sun above the horizon, found z = {}", result.z);
  return {0, 0, 1};
}

double turbidity_of(const SdlNode& node, double least, double most) {
  const double turbidity = node.number("turbidity", 2.2);
  if (turbidity >= least && turbidity <= most) return turbidity;
  node.error("turbidity", "wanted a number in [{}, {}], found {}", least, most, turbidity);
  return 2.2;
}

/// A larger disc is as bright on the ground: its radiance falls as its area grows.
void read_sun(const SdlNode& node, Light& light) {
  light.kind = LightKind::sun;
  const Vec3d direction = sun_direction(node);
  const double turbidity = turbidity_of(node, 1, 30);
  double relsize = node.number("relsize", 1);
  if (!(relsize > 0 && relsize <= 200)) {
    node.error("relsize", "wanted a number in (0, 200], found {}", relsize);
    relsize = 1;
  }
  const double sin_radius = k_sun_sin_radius * relsize;
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
  light.upper_hemisphere_only = node.flag("sampleupperhemisphereonly", false);
  light.image = read_image(node, 1, ImageUse::light);
}

void read_constant_infinite(const SdlNode& node, Light& light) {
  light.kind = LightKind::constant_infinite;
  light.color = to_float(common_factor(node) * node.color("color", {1, 1, 1}));
  node.matrix("transformation");
}

/// sky2 becomes an infinite light with a picture of its own.
void read_sky(const SdlNode& node, Light& light) {
  light.kind = LightKind::infinite;
  light.color = to_float(common_factor(node));
  SkySettings sky;
  sky.sun_direction = sun_direction(node);
  sky.turbidity = turbidity_of(node, 1.7, 10);
  sky.ground_albedo = node.color("groundalbedo", sky.ground_albedo);
  if (sky.ground_albedo.x > 1 || sky.ground_albedo.y > 1 || sky.ground_albedo.z > 1)
    node.error("groundalbedo", "wanted three numbers in [0, 1]");
  sky.ground_enable = node.flag("ground.enable", sky.ground_enable);
  sky.ground_autoscale = node.flag("ground.autoscale", sky.ground_autoscale);
  sky.ground_color = node.color("ground.color", sky.ground_color);
  std::vector<Image>& images = node.reader().scene.images;
  light.image = static_cast<int>(images.size());
  images.push_back(make_sky_image(sky));
}

struct LightReader {
  std::string_view type;
  void (*read)(const SdlNode&, Light&);
};
constexpr LightReader k_readers[] = {
    {"point", read_point},       {"spot", read_spot},
    {"sun", read_sun},           {"sky2", read_sky},
    {"infinite", read_infinite}, {"constantinfinite", read_constant_infinite}};

void read_light(const SdlNode& node) {
  const std::string type = node.type("sky2");
  for (const LightReader& reader : k_readers) {
    if (reader.type != type) continue;
    Light light;
    light.name = node.name();
    reader.read(node, light);
    node.reader().scene.lights.push_back(std::move(light));
    return;
  }
  node.refuse_type(type);
}

}  // namespace

Vec3d temperature_factor(const SdlNode& node, std::string_view property) {
  const double kelvin = node.number(property, -1);
  const bool normalize = node.flag(fmt::format("{}.normalize", property), false);
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

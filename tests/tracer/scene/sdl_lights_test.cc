// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_parameters.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

// The expected values were measured in LuxCore 2.11.2 (pyluxcore, PATHCPU, SOBOL, film output RGB,
// filter NONE): a white matte plane at z = 0 under one light, path depth 1, seen from above at its
// centre; irradiance = pi * film. Closed forms that reproduce them to five digits stand beside
// them.

namespace ds {
namespace {

using ::ds::testing::k_matte_body;
using ::ds::testing::k_square;
using ::ds::testing::SdlFolder;
using portable::k_pi;

constexpr double k_relative = 1e-4;  // the oracle's noise at 64 samples of a smooth function

Light light_of(std::string_view properties) {
  const SdlFolder folder;
  std::string text;
  for (std::size_t start = 0; start < properties.size();) {
    const std::size_t end = properties.find('\n', start);
    text += "scene.lights.l." + std::string(properties.substr(start, end - start)) + "\n";
    start = end == std::string_view::npos ? properties.size() : end + 1;
  }
  return folder.environment(text).lights.at(0);
}

void expect_near(Vec3 found, Vec3d wanted, double relative) {
  for (int band = 0; band < 3; ++band)
    EXPECT_NEAR(double{found[band]}, wanted[band], relative * std::fabs(wanted[band]) + 1e-12)
        << "band " << band;
}

struct LampCase {
  const char* properties;
  Vec3d irradiance;  ///< of the plane's centre, 2 m below the lamp
};

class Lamps : public ::testing::TestWithParam<LampCase> {};

TEST_P(Lamps, IrradianceIsLuxCores) {
  const Light light = light_of(GetParam().properties);
  expect_near(light.color, GetParam().irradiance * 4.0, k_relative);
}

INSTANTIATE_TEST_SUITE_P(
    Point, Lamps,
    ::testing::Values(
        LampCase{"type = point", {0.01989456, 0.01989456, 0.01989456}},  // 1 / (4 pi)
        LampCase{"type = point\ncolor = .2 .4 .8\ngain = 3 3 3", {0.0119367, 0.0238734, 0.0477468}},
        // power without an efficiency, whose default is 0, does nothing
        LampCase{"type = point\npower = 100", {0.01989456, 0.01989456, 0.01989456}},
        LampCase{"type = point\npower = 100\nefficiency = 15", {29.841892, 29.841892, 29.841892}},
        LampCase{"type = point\npower = 100\nefficiency = 15\ncolor = .2 .4 .8",
                 {15.448723, 30.897446, 61.79489}},
        LampCase{"type = point\npower = 100\nefficiency = 15\ncolor = .2 .4 .8\ngain = 3 3 3",
                 {46.34689, 92.69378, 185.38756}},
        LampCase{
            "type = point\npower = 100\nefficiency = 15\ncolor = .2 .4 .8\nnormalizebycolor = 0",
            {5.9683647, 11.936729, 23.873459}}));

INSTANTIATE_TEST_SUITE_P(
    Spot, Lamps,
    ::testing::Values(
        LampCase{"type = spot\ntarget = 0 0 -1", {0.25, 0.25, 0.25}},
        LampCase{"type = spot\ntarget = 0 0 -1\npower = 100\nefficiency = 15",
                 {524.30756, 524.30756, 524.30756}},
        LampCase{"type = spot\ntarget = 0 0 -1\npower = 100\nefficiency = 15\ncolor = .2 .4 .8",
                 {271.4272, 542.8544, 1085.7087}},
        LampCase{"type = spot\ntarget = 0 0 -1\npower = 100\nefficiency = 15\ncolor = .2 .4 "
                 ".8\nnormalizebycolor = 0",
                 {104.861404, 209.72281, 419.44562}},
        LampCase{"type = spot\ntarget = 0 0 -1\nconeangle = 60\nconedeltaangle = 20\npower = "
                 "100\nefficiency = 15",
                 {162.63571, 162.63571, 162.63571}}));

TEST(Spot, ConeAngleIsHalfTheConeAndTheFalloffItsRim) {
  const Light light =
      light_of("type = spot\nposition = 0 0 2\ntarget = 0 0 0\nconeangle = 30\nconedeltaangle = 5");
  EXPECT_NEAR(double{*light_value(light, "cos_total")}, std::cos(portable::radians(30)), 1e-7);
  EXPECT_NEAR(double{*light_value(light, "cos_falloff")}, std::cos(portable::radians(25)), 1e-7);
  EXPECT_EQ(light_vector(light, "position"), (Vec3{0, 0, 2}));
  EXPECT_EQ(light_vector(light, "direction"), (Vec3{0, 0, -1}));
  // LuxCore's plane at the angle from the axis, lamp 2 m above it: irradiance. It fixes the formula
  // in scene.h.
  struct Rim {
    double angle_deg;
    double irradiance;
  };
  for (const Rim rim :
       {Rim{10, 0.24246386}, Rim{24, 0.20864305}, Rim{26, 0.08843275}, Rim{27.5, 0.01448597}}) {
    const double c = std::cos(portable::radians(rim.angle_deg));
    const double edge =
        double{*light_value(light, "cos_falloff")} - double{*light_value(light, "cos_total")};
    const double falloff =
        std::pow(std::fmin((c - double{*light_value(light, "cos_total")}) / edge, 1), 4);
    const double irradiance = double{light.color.x} * falloff / c * (c * c * c / 4);
    EXPECT_NEAR(irradiance / rim.irradiance, 1, 1e-3) << rim.angle_deg;
  }
}

TEST(Spot, ASharpEdgeHasAWidth) {
  const Light light = light_of("type = spot\ntarget = 0 0 -1\nconeangle = 40\nconedeltaangle = 0");
  const float total = *light_value(light, "cos_total"),
              falloff = *light_value(light, "cos_falloff");
  EXPECT_GT(falloff, total);
  EXPECT_NEAR(falloff, total, 1e-7);
}

TEST(Lights, TransformationIsColumnByColumn) {
  const Light point =
      light_of("type = point\nposition = 1 0 0\ntransformation = 0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1");
  EXPECT_EQ(light_vector(point, "position"), (Vec3{5, 7, 7}));
  const Light spot =
      light_of("type = spot\ntarget = 1 0 0\ntransformation = 0 1 0 0 -1 0 0 0 0 0 1 0 5 6 7 1");
  EXPECT_EQ(light_vector(spot, "position"), (Vec3{5, 6, 7}));
  EXPECT_EQ(light_vector(spot, "direction"), (Vec3{0, 1, 0}));
}

TEST(ConstantInfinite, RadianceIsGainTimesColour) {
  // pi * radiance = 1.2567 2.5134 5.0268
  const Light light = light_of("type = constantinfinite\ncolor = .2 .4 .8\ngain = 2 2 2");
  EXPECT_EQ(type_of(light).kernel_prefix, "constant_infinite");
  expect_near(light.color, {0.4, 0.8, 1.6}, 1e-6);
}

/// (u, v) of a world direction in the image, by the convention of Light::light_to_world.
Vec2 image_position(const Light& light, Vec3d world) {
  const Vec3d d = normalized(portable::inverse(light.light_to_world).direction(world));
  const double u = 0.5 - std::atan2(d.y, d.x) / (2 * k_pi);
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(std::acos(d.z) / k_pi)};
}

TEST(Infinite, OrientationIsLuxCores) {
  const SdlFolder folder;
  folder.write("map.exr", "not decoded by the reader");
  const std::string base =
      "scene.lights.l.type = infinite\nscene.lights.l.file = map.exr\nscene.lights.l.gamma = 1\n";
  const Scene scene = folder.environment(base + "scene.lights.l.gain = 2 3 4\n");
  const Light& light = scene.lights.at(0);
  EXPECT_EQ(type_of(light).kernel_prefix, "infinite");
  EXPECT_EQ(light.color, (Vec3{2, 3, 4}));
  ASSERT_EQ(light.image, 0);
  EXPECT_EQ(scene.images[0].gamma, 1);
  // A map whose red is u and green v (0 at the left and top), each direction looked at through
  // LuxCore's camera.
  struct Look {
    Vec3d direction;
    double u, v;
  };
  for (const Look& look : {Look{{0, 1, 0}, 0.25, 0.5}, Look{{0, -1, 0}, 0.75, 0.5},
                           Look{{1, 1, 0}, 0.125, 0.5}, Look{{-1, 0.2, 0}, 0.46858, 0.5},
                           Look{{1, 0.2, 0}, 0.031416, 0.5}, Look{{0, 1, 0.3}, 0.25, 0.40717}}) {
    const Vec2 found = image_position(light, look.direction);
    EXPECT_NEAR(double{found.x}, look.u, 2e-4);
    EXPECT_NEAR(double{found.y}, look.v, 2e-4);
  }
  // Turned by 30 degrees about z, LuxCore shows u = 0.16666 at azimuth 90.
  const Scene turned = folder.environment(base +
                                          "scene.lights.l.transformation = 0.8660254037844387 0.5 "
                                          "0 0 -0.5 0.8660254037844387 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_NEAR(double{image_position(turned.lights.at(0), {0, 1, 0.3}).x}, 0.16666, 2e-4);
  EXPECT_NE(folder.environment_error(
                base + "scene.lights.l.transformation = 2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"),
            "");
}

/// A value that is not the default.
std::string other_value(const LightInput& input) {
  if (input.value == LightValue::number)
    return fmt::format("{}", std::stod(std::string(input.default_value)) * 0.5);
  return "0.3 0.5 0.7";
}

TEST(Lights, EachIsReadFromItsTable) {
  const SdlFolder folder;
  int read = 0;
  for (const LightType& type : light_types()) {
    if (type.name.empty() || (type.host.made_by & kernels::k_host_panorama) != 0) continue;
    const std::string plain = fmt::format("scene.lights.l.type = {}\n", type.name);
    const auto canonical = [&](const std::string& more) {
      return canonical_environment(folder.environment(plain + more));
    };
    const Light light = folder.environment(plain).lights.at(0);
    EXPECT_EQ(&type_of(light), &type);
    EXPECT_NE(canonical("scene.lights.l.gain = 2 2 2\n"), canonical("")) << type.name;
    const SdlTypeRow* row = find_type(light_section(), type.name);
    ASSERT_NE(row, nullptr) << type.name;
    EXPECT_EQ(row->help, header_comment("lights", type.kernel_prefix));
    for (const LightInput& input : type.host.inputs) {
      EXPECT_NE(canonical("").find(fmt::format("lights.l.{} = ", input.name)), std::string::npos)
          << canonical("");
      if (input.default_value.empty()) continue;
      ++read;
      const SdlParameter* parameter = find_parameter(light_section(), row, input.name);
      ASSERT_NE(parameter, nullptr) << type.name << " " << input.name;
      EXPECT_EQ(parameter->help, input.help);
      const std::string line = fmt::format("scene.lights.l.{} = ", input.name);
      EXPECT_EQ(canonical(line + std::string(input.default_value) + "\n"), canonical(""))
          << type.name << " " << input.name;
      EXPECT_NE(canonical(line + other_value(input) + "\n"), canonical(""))
          << type.name << " " << input.name;
      // Points and directions are turned and moved with the light.
      if (input.value == LightValue::point || input.value == LightValue::direction) {
        const Light turned = folder
                                 .environment(plain + line +
                                              "0 0 2\nscene.lights.l.transformation = "
                                              "0 1 0 0 -1 0 0 0 0 0 -1 0 5 6 7 1\n")
                                 .lights.at(0);
        EXPECT_EQ(light_vector(turned, input.name),
                  input.value == LightValue::point ? (Vec3{5, 6, 5}) : (Vec3{0, 0, -1}))
            << type.name << " " << input.name;
      }
    }
  }
  EXPECT_GE(read, 4);
}

struct EmissionCase {
  const char* properties;
  Vec3d radiance;
};

class Emission : public ::testing::TestWithParam<EmissionCase> {};

TEST_P(Emission, RadianceIsLuxCores) {
  const SdlFolder folder;
  // LuxCore's square had an area of 1.
  const Scene scene = folder.environment(
      "scene.objects.e.vertices = -.5 -.5 2 .5 -.5 2 .5 .5 2 -.5 .5 2\nscene.objects.e.faces = 0 1 "
      "2 0 2 3\n"
      "scene.objects.e.material = e\n" +
      std::string(GetParam().properties));
  const Material& material =
      scene.materials.at(static_cast<std::size_t>(scene.objects.at(0).material));
  EXPECT_TRUE(material.emits);
  EXPECT_EQ(material.emission.texture, -1);
  expect_near(material.emission.constant, GetParam().radiance, k_relative);
}

#define DS_EMISSION "scene.materials.e.emission"
INSTANTIATE_TEST_SUITE_P(
    Area, Emission,
    ::testing::Values(
        EmissionCase{DS_EMISSION " = .2 .4 .8", {0.2, 0.4, 0.8}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".gain = 2 3 4", {0.4, 1.2, 3.2}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".power = 100", {0.2, 0.4, 0.8}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".power = 100\n" DS_EMISSION
                                 ".efficiency = 15",
                     {247.17767, 494.35535, 988.7107}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".power = 100\n" DS_EMISSION
                                 ".efficency = 15\n" DS_EMISSION ".normalizebycolor = 0",
                     {95.493286, 190.98657, 381.97314}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".power = 100\n" DS_EMISSION
                                 ".efficiency = 15\n" DS_EMISSION ".gain = 2 3 4",
                     {494.35364, 1483.0627, 3954.829}},
        EmissionCase{DS_EMISSION " = .2 .4 .8\n" DS_EMISSION ".gain = 2 3 4\n" DS_EMISSION
                                 ".gain.normalizebycolor = 1",
                     {1.0353727, 3.1061363, 8.282982}}));
#undef DS_EMISSION

TEST(EmissionByPower, EachObjectHasItsOwnArea) {
  const SdlFolder folder;
  const Scene scene = folder.environment(
      "scene.materials.body.emission = 1\nscene.materials.body.emission.power = 8\n"
      "scene.materials.body.emission.efficiency = 1\n" +
      std::string(k_square) +
      "scene.objects.large.vertices = 0 0 0 4 0 0 4 4 0 0 4 0\nscene.objects.large.faces = 0 1 2 0 "
      "2 3\n"
      "scene.objects.large.material = body\n");
  ASSERT_EQ(scene.objects.size(), 2u);
  const auto radiance = [&](std::size_t object) {
    return double{scene.materials.at(static_cast<std::size_t>(scene.objects[object].material))
                      .emission.constant.x};
  };
  EXPECT_NEAR(radiance(0), 8 / (k_pi * 16), 1e-6);
  EXPECT_NEAR(radiance(1), 8 / (k_pi * 4), 1e-6);
}

}  // namespace
}  // namespace ds

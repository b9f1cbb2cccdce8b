// SPDX-License-Identifier: Apache-2.0
// Every light of kernels/lists.h that is told by numbers, over what the table says of them: what it sends,
// how that falls with distance, what next-event estimation and a ray that meets it find, and its power.
#include "tests/tracer/kernels/packed_light.h"
#include "tracer/base/error.h"
#include "tracer/kernels/lists.h"
#include "tracer/scene/sdl_parameters.h"
#include "tracer/scene/told_lights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>

namespace ds {
namespace {

using namespace kernels;

constexpr double k_pi = std::numbers::pi;

/// The kernel's functions of a row of light_types().
struct LightFunctions {
  LightSample (*sample)(LightTables t, uint at, real3 from, real2 u);
  real3 (*escape)(LightTables t, uint at, real3 direction, real* pdf) = nullptr;
};
LightFunctions functions_of(const Light& light) {
#define DS_UNMET(sdl_name, prefix) LightFunctions{prefix##_sample},
#define DS_BEYOND(sdl_name, prefix) LightFunctions{prefix##_sample, prefix##_escape},
  static constexpr std::array rows = {LightFunctions{mesh_sample},
                                      DS_UNMET_LIGHTS(DS_UNMET) DS_BEYOND_LIGHTS(DS_BEYOND)};
#undef DS_BEYOND
#undef DS_UNMET
  return rows[static_cast<std::size_t>(light.type)];
}

class LightInputs : public testing::TestWithParam<const SdlTypeRow*> {
 protected:
  float number() { return unit_interval(static_cast<uint>(random_())); }
  double between(double low, double high) { return low + (high - low) * double{number()}; }
  real2 numbers() {
    const float x = number();
    return {x, number()};
  }
  real3 direction() {
    const double z = between(-1, 1), turn = between(-k_pi, k_pi), s = std::sqrt(1 - z * z);
    return vec(static_cast<float>(s * std::cos(turn)), static_cast<float>(s * std::sin(turn)),
               static_cast<float>(z));
  }

  /// Of a property's range its ends, its default (nothing), and anything between.
  std::vector<double> drawn(const SdlParameter& p) {
    const bool three = p.type == SdlType::vector || p.type == SdlType::color;
    const bool is_number = p.type == SdlType::number || p.type == SdlType::flag;
    const float choice = number();
    if ((!three && !is_number) || choice < 0.2f) return {};
    if (p.type == SdlType::flag) return {number() < 0.5f ? 0.0 : 1.0};
    // Powers and temperatures apart, which are looked at by tests of their own.
    const double low = std::isinf(p.range.least) ? -3 : p.range.least;
    const double high = std::isinf(p.range.most) ? low + 6 : p.range.most;
    const double width = high - low;
    std::vector<double> values;
    for (int i = 0; i < (three ? 3 : 1); ++i) {
      double value = between(low, high);
      if (choice < 0.3f) value = p.range.open_least ? low + 1e-3 * width : low;
      if (choice > 0.9f) value = p.range.open_most ? high - 1e-3 * width : high;
      values.push_back(three && p.type == SdlType::vector ? between(low, high) : value);
    }
    return values;
  }

  /// A light of the type; numbers that do not go together, or make none, are drawn again.
  Light draw() {
    for (int i = 0; i < 1000; ++i) {
      ToldLight told{"light", GetParam()->name, {}};
      for (const SdlParameter& p : GetParam()->parameters)
        if (const std::vector<double> values = drawn(p); !values.empty())
          told.values.emplace_back(p.name, values);
      try {
        // A black light is not packed.
        if (Light light = make_told_light(told); !(light.color == Vec3{})) return light;
      } catch (const Error&) {
      }
    }
    throw std::runtime_error("no numbers of the light's ranges go together");
  }
  static Scene scene_of(const Light& light) {
    Scene scene = lit_scene();
    scene.lights.push_back(light);
    return scene;
  }

  std::mt19937 random_{5};
};

double luminance_of(real3 c) {
  return double{kernels::luminance(c)};
}

/// A light's numbers as its functions on the host take them.
std::vector<float> host_inputs(const Light& light) {
  std::vector<float> inputs{light.color.x, light.color.y, light.color.z};
  inputs.insert(inputs.end(), light.values.begin(), light.values.end());
  return inputs;
}

constexpr int k_draws = 40;

TEST_P(LightInputs, SamplesAreFiniteAndGoToTheLight) {
  for (int trial = 0; trial < k_draws; ++trial) {
    const Light light = draw();
    const LightFunctions kernel = functions_of(light);
    const PackedLight packed(scene_of(light));
    for (int i = 0; i < 1000; ++i) {
      const float far = std::pow(10.0f, static_cast<float>(i % 7 - 3));
      const real3 from = scale(direction(), far);
      const float ends[3] = {0.0f, 0.99999994f, number()};
      const LightSample s =
          kernel.sample(packed.tables(), PackedLight::at, from, {ends[i % 3], ends[i / 3 % 3]});
      ASSERT_TRUE(s.pdf >= 0 && std::isfinite(s.pdf)) << far;
      if (s.pdf == 0) continue;
      for (const float x : {s.radiance.x, s.radiance.y, s.radiance.z})
        ASSERT_TRUE(x >= 0 && std::isfinite(x)) << far << ", radiance " << x;
      ASSERT_NEAR(double{dot(s.wi, s.wi)}, 1, 1e-5);
      if (!s.bounded) continue;
      const real3 way = sub(s.target, from);
      ASSERT_NEAR(double{dot(way, s.wi)}, std::sqrt(double{dot(way, way)}),
                  1e-5 * std::sqrt(double{dot(way, way)}));
    }
  }
}

TEST_P(LightInputs, FallsWithTheSquareOfTheDistanceOrIsFarFromAll) {
  for (int trial = 0; trial < k_draws; ++trial) {
    const Light light = draw();
    const LightFunctions kernel = functions_of(light);
    const PackedLight packed(scene_of(light));
    for (int i = 0; i < 200; ++i) {
      const real2 u = numbers();
      const LightSample at = kernel.sample(packed.tables(), PackedLight::at, direction(), u);
      if (at.pdf == 0) continue;
      // From farther back along the way, or, of what lies beyond the scene, from anywhere.
      const double far = std::pow(10.0, between(-1, 3));
      const real3 from = at.bounded ? add_scaled(at.target, at.wi, static_cast<float>(-far))
                                    : scale(direction(), static_cast<float>(far));
      const LightSample then = kernel.sample(packed.tables(), PackedLight::at, from, u);
      ASSERT_EQ(then.bounded, at.bounded);
      if (at.bounded && !at.dirac) continue;  // of a surface the radiance is the same
      const auto strength = [](const LightSample& s, real3 place) {
        const real3 way = sub(s.target, place);
        return luminance_of(s.radiance) / double{s.pdf} * (s.bounded ? double{dot(way, way)} : 1);
      };
      if (!at.bounded) {
        ASSERT_NEAR(strength(then, from), strength(at, from), 1e-5 * strength(at, from));
        continue;
      }
      const real3 place = add_scaled(at.target, at.wi, -1.0f);
      const LightSample near = kernel.sample(packed.tables(), PackedLight::at, place, u);
      const double want = strength(near, place);
      // The way is the same but for rounding, which a steep ramp of a cone's makes more of.
      const double color = luminance_of(vec(light.color.x, light.color.y, light.color.z));
      ASSERT_NEAR(strength(then, from), want, 1e-2 * want + 1e-4 * color);
    }
  }
}

TEST_P(LightInputs, IsTheSameByNextEventAndByARayThatMeetsIt) {
  for (int trial = 0; trial < k_draws; ++trial) {
    const Light light = draw();
    const LightFunctions kernel = functions_of(light);
    if (kernel.escape == nullptr) GTEST_SKIP() << "no ray meets it";
    const PackedLight packed(scene_of(light));
    int sampled = 0, differ = 0;
    for (int i = 0; i < 5000; ++i) {
      const LightSample s = kernel.sample(packed.tables(), PackedLight::at, direction(), numbers());
      if (s.pdf == 0) continue;
      ++sampled;
      float pdf = 0;
      const real3 met = kernel.escape(packed.tables(), PackedLight::at, s.wi, &pdf);
      // On a rim or a cell's border a rounding decides.
      if (std::fabs(pdf / s.pdf - 1) > 1e-3f ||
          std::fabs(met.y - s.radiance.y) > 1e-3f * (met.y + s.radiance.y))
        ++differ;
    }
    EXPECT_LE(differ, sampled / 100);
    // Of what is never sampled no ray may be weighed against a sample.
    for (int i = 0; sampled == 0 && i < 1000; ++i) {
      float pdf = 1;
      kernel.escape(packed.tables(), PackedLight::at, direction(), &pdf);
      ASSERT_EQ(pdf, 0);
    }
  }
}

/// Of what lies beyond the scene, by samples; of what stands in it, through a sphere around it. Nothing
/// where too few of its places are lit to tell.
std::optional<double> light_of(const PackedLight& packed, const LightFunctions& kernel, Vec3 middle,
                               double scene_radius, const std::function<real3()>& direction,
                               const std::function<real2()>& numbers) {
  constexpr int k_samples = 40000;
  double sum = 0;
  int lit = 0;
  for (int i = 0; i < k_samples; ++i) {
    const real3 from = add(vec(middle.x, middle.y, middle.z), direction());
    const LightSample s = kernel.sample(packed.tables(), PackedLight::at, from, numbers());
    if (s.pdf == 0) continue;
    ++lit;
    const double share = luminance_of(s.radiance) / double{s.pdf};
    sum += share * (s.bounded ? 4 * k_pi : k_pi * scene_radius * scene_radius);
  }
  return lit < 200 ? std::nullopt : std::optional(sum / k_samples);
}

// What is chosen by its power wants only to be near it; a factor that is missing is not near.
TEST_P(LightInputs, PowerIsWhatItSends) {
  int compared = 0;
  for (int trial = 0; trial < k_draws; ++trial) {
    const Light light = draw();
    const LightType& type = type_of(light);
    if (type.host.power == nullptr)
      GTEST_SKIP() << "its power is of its tables, or it is not sampled";
    const double scene_radius = between(0.1, 10);
    const std::vector<float> inputs = host_inputs(light);
    const double told =
        type.host.power(luminance_of(vec(light.color.x, light.color.y, light.color.z)),
                        inputs.data(), scene_radius);
    Vec3 middle{};
    for (const LightInput& input : type.host.inputs)
      if (input.value == LightValue::point) middle = light_vector(light, input.name);
    const std::optional<double> sent = light_of(
        PackedLight(scene_of(light)), functions_of(light), middle, scene_radius,
        [&] { return direction(); }, [&] { return numbers(); });
    if (!sent) continue;
    ++compared;
    ASSERT_GE(*sent, 0.35 * told) << "told " << told;
    ASSERT_LE(*sent, 2.9 * told) << "told " << told;
  }
  EXPECT_GE(compared, k_draws / 3);
}

std::string test_name(const testing::TestParamInfo<const SdlTypeRow*>& info) {
  return info.param->name;
}
INSTANTIATE_TEST_SUITE_P(Every, LightInputs, testing::ValuesIn(told_light_types()), test_name);

}  // namespace
}  // namespace ds

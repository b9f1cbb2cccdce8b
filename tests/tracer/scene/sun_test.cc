// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/base/luminance.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/spectrum.h"
#include "tracer/scene/sun_model.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

using ::ds::testing::SdlFolder;
using portable::k_pi;

// Radiance of the disc in LuxCore 2.11.2 (PATHCPU): scene.lights.l = sun with the turbidity and
// elevation, a camera of 0.001 degrees pointed at it, film output RGB.
struct Measured {
  double elevation_deg;
  double turbidity;
  Vec3d radiance;
  double tolerance;  ///< relative; each band
};
// The blue of a low sun is what is left of an exponential and a thousandth of the red, so it is not
// asked for below 15.
constexpr Measured k_measured[] = {
    {20, 2.2, {1152331904, 882640576, 601071616}, 0.02},
    {45, 2.2, {1523570688, 1291892224, 1087606016}, 0.005},
    {60, 2.2, {1599114496, 1379758848, 1205493504}, 0.005},
    {90, 2.2, {1646153600, 1434841600, 1281849088}, 0.006},
    {30, 3.0, {1201643008, 946337792, 697830016}, 0.01},
    {45, 5.0, {1107997952, 862662272, 642495488}, 0.01},
    {90, 10.0, {877525760, 647124288, 453563648}, 0.02},
    {15, 2.2, {971505728, 698338944, 418191456}, 0.03},
};

TEST(Sun, DiscRadianceAgreesWithLuxCore) {
  for (const Measured& m : k_measured) {
    const double elevation = portable::radians(m.elevation_deg);
    const Vec3d direction{std::cos(elevation), 0, std::sin(elevation)};
    const Vec3d radiance = sun_radiance(direction, m.turbidity);
    for (int band = 0; band < 3; ++band)
      EXPECT_NEAR(radiance[band] / m.radiance[band], 1, m.tolerance)
          << m.elevation_deg << " degrees, turbidity " << m.turbidity << ", band " << band;
  }
}

TEST(Sun, LowAndHazySunsAreRedAndNeverNegative) {
  for (double turbidity = 1; turbidity <= 30; turbidity += 0.5)
    for (double z = 0; z <= 1; z += 0.05) {
      const Vec3d radiance = sun_radiance({std::sqrt(1 - z * z), 0, z}, turbidity);
      EXPECT_GE(radiance.x, 0);
      EXPECT_GE(radiance.y, 0);
      EXPECT_GE(radiance.z, 0);
      if (radiance.x > 1) {
        EXPECT_GE(radiance.x, radiance.y);
      }
      EXPECT_TRUE(std::isfinite(radiance.x));
    }
}

TEST(Sun, IrradianceDoesNotDependOnTheDiscsSize) {
  // E = 73428 62267 52420 at relsize 1, 73144 62026 52217 at relsize 4: a white matte plane under
  // LuxCore's sun at 45 degrees; both are the disc's radiance times pi sin^2(radius) sin(45 deg) =
  // 73152 62028 52219 but for its noise.
  constexpr Vec3d k_measured_irradiance{73144, 62026, 52217};
  const SdlFolder folder;
  for (const char* relsize : {"1", "4", "0.5"}) {
    const Scene scene = folder.environment(
        std::string(
            "scene.lights.l.type = sun\nscene.lights.l.dir = 1 0 1\nscene.lights.l.relsize = ") +
        relsize);
    ASSERT_EQ(scene.lights.size(), 1u);
    const Light& light = scene.lights[0];
    EXPECT_EQ(type_of(light).kernel_prefix, "sun");
    EXPECT_NEAR(light_vector(light, "direction").x, std::sqrt(0.5), 1e-7);
    const double cosine = double{*light_value(light, "cos_total")};
    const double projected = k_pi * (1 - cosine * cosine) * std::sqrt(0.5);
    for (int band = 0; band < 3; ++band)
      EXPECT_NEAR(double{light.color[band]} * projected / k_measured_irradiance[band], 1, 0.005);
    // The disc's edge: LuxCore shows light at 0.265 degrees from the centre and none at 0.27.
    const double radius_deg = std::acos(cosine) * 180 / k_pi / std::stod(relsize);
    EXPECT_NEAR(radius_deg, 0.2664, 0.001);
  }
}

TEST(Spectrum, AFlatSpectrumIsWhiteE) {
  const Vec3d rgb = spectrum_to_rgb([](double) { return 1.0; });
  EXPECT_NEAR(luxcore_luminance(rgb), 1, 1e-3);
  // Linear Rec.709 of the equal-energy white, xy = 1/3, from the matrix of ITU-R BT.709.
  EXPECT_NEAR(rgb.x, 1.2048, 0.01);
  EXPECT_NEAR(rgb.y, 0.9483, 0.01);
  EXPECT_NEAR(rgb.z, 0.9089, 0.01);
}

TEST(Spectrum, BlackBodyColoursAgreeWithLuxCore) {
  // A LuxCore point light of the temperature over a white plane, divided by the same without a
  // temperature.
  struct Temperature {
    double kelvin;
    Vec3d color;
    double tolerance;
  };
  constexpr Temperature k_temperatures[] = {{3000, {0.77557, 0.36061, 0.11991}, 0.035},
                                            {6500, {0.74611, 0.71484, 0.75573}, 0.02},
                                            {10000, {0.36021, 0.42380, 0.61302}, 0.04}};
  for (const Temperature& t : k_temperatures) {
    const Vec3d color = black_body_color(t.kelvin, true);
    for (int band = 0; band < 3; ++band)
      EXPECT_NEAR(color[band] / t.color[band], 1, t.tolerance) << t.kelvin << " K, band " << band;
    const Vec3d absolute = black_body_color(t.kelvin, false);
    EXPECT_NEAR(absolute.x / color.x, 89160, 1);
  }
}

}  // namespace
}  // namespace ds

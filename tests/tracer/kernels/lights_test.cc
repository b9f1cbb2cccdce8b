// SPDX-License-Identifier: Apache-2.0
// Every light as the packer writes it: what it samples is what its pdf says.
#include "tests/render/pictures.h"
#include "tests/tracer/kernels/chi_square.h"
#include "tests/tracer/kernels/packed_light.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"
#include "tracer/render/images.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace ds {
namespace {

using namespace kernels;

constexpr double k_pi = std::numbers::pi;

/// Turned about x and z, and mirrored, as the SDL reader makes it for image files.
Mat4 turned() {
  const double c = std::cos(0.6), s = std::sin(0.6);
  const Mat4 about_z{{c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  const Mat4 about_x{{1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 0, 0, 1}};
  const Mat4 mirror{{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  return about_z * about_x * mirror;
}

Scene image_scene(Image image, const Mat4& light_to_world) {
  Scene scene = lit_scene();
  scene.images.push_back(std::move(image));
  scene.lights.push_back(pictures::image_light(0));
  scene.lights[0].light_to_world = light_to_world;
  return scene;
}

real3 direction(double z, double azimuth) {
  const double s = std::sqrt(std::max(0.0, 1 - z * z));
  return vec(static_cast<float>(s * std::cos(azimuth)), static_cast<float>(s * std::sin(azimuth)),
             static_cast<float>(z));
}

/// Samples against the pdf's integral over equal cells of the sphere; the integral over all must
/// be 1.
void expect_samples_follow_pdf(const PackedLight& light, int steps, double integral_error) {
  constexpr SphereCells cells{16, 32};
  constexpr int k_samples = 200000;
  std::vector<double> counts(cells.count());
  std::mt19937 random(3);
  int differ = 0;
  for (int i = 0; i < k_samples; ++i) {
    const real2 u = {unit_interval(static_cast<uint>(random())),
                     unit_interval(static_cast<uint>(random()))};
    const LightSample s = infinite_sample(light.tables(), PackedLight::at, vec(0, 0, 0), u);
    if (s.pdf == 0) continue;
    float pdf = 0;
    const real3 radiance = infinite_escape(light.tables(), PackedLight::at, s.wi, &pdf);
    // At a cell's border a rounding decides between two densities.
    if (std::fabs(pdf / s.pdf - 1) > 1e-3f ||
        std::fabs(radiance.x - s.radiance.x) > 1e-3f * (radiance.x + s.radiance.x))
      ++differ;
    counts[cells.cell(s.wi.x, s.wi.y, s.wi.z)] += 1;
  }
  EXPECT_LT(differ, k_samples / 100);
  std::vector<double> expected = cells.integrals(steps, [&](double z, double azimuth) {
    float pdf = 0;
    infinite_escape(light.tables(), PackedLight::at, direction(z, azimuth), &pdf);
    return pdf;
  });
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  EXPECT_NEAR(total, 1, integral_error);
  for (double& e : expected)
    e *= k_samples / total;
  EXPECT_GT(chance_of_counts(counts, expected), 0.005);
}

TEST(InfiniteLight, ASmallImageOfHighContrastIsSampledAsItsPdfSays) {
  expect_samples_follow_pdf(PackedLight(image_scene(pictures::small_sky(), Mat4{})), 150, 2e-3);
  expect_samples_follow_pdf(PackedLight(image_scene(pictures::small_sky(), turned())), 150, 2e-3);
}

TEST(InfiniteLight, ARealImageIsSampledAsItsPdfSays) {
  Image image;
  image.file = DS_SOURCE_DIR "/../shared/data/hdri/studio.exr";
  image.gamma = 1;
  if (!std::filesystem::exists(image.file)) GTEST_SKIP() << "no " << image.file;
  load_image(image);
  // The midpoint rule's error is that of a few bright texels.
  expect_samples_follow_pdf(PackedLight(image_scene(image, turned())), 100, 0.02);
}

TEST(InfiniteLight, LooksUpTheTexelsWhereTheSceneSays) {
  // scene.h: u = 0.5 - azimuth / 2 pi, v = polar / pi, (0, 0) the top left corner.
  const Image image = pictures::small_sky();
  const PackedLight light(image_scene(image, Mat4{}));
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double azimuth = (0.5 - (column + 0.5) / image.width) * 2 * k_pi;
      const double polar = (row + 0.5) / image.height * k_pi;
      float pdf = 0;
      const real3 seen = infinite_escape(light.tables(), PackedLight::at,
                                         direction(std::cos(polar), azimuth), &pdf);
      const float want = image.rgb[static_cast<std::size_t>(3 * (row * image.width + column))];
      // The brightest texel's neighbours get 1e-6 of it for each rounding of the place.
      EXPECT_NEAR(seen.x, want, 1e-4 * double{want} + 5e-3) << column << ", " << row;
    }
}

TEST(InfiniteLight, KeepsTexelsInOneWordWhereThatIsExact) {
  // Mantissas of 8 bits under a common exponent, over the range of .hdr files; black too.
  Image image;
  image.file = "words";
  image.width = 4;
  image.height = 2;
  image.rgb = {255, 128, 1,       0,        0, 0,        0x1.06p-10f, 0,  0,   0.75f, 0.5f, 0.25f,
               0,   0,   0x1p20f, 0x1p-20f, 0, 0x1p-26f, 3,           17, 200, 42,    7,    0.25f};
  const auto words_of = [](const Image& of) {
    const Scene scene = image_scene(of, Mat4{});
    const PackedScene packed = pack_scene(scene, scene_effects(scene, Camera{}), BvhQuality::low);
    return packed.lights.words()[PackedLight::at + infinite_shared_exponent];
  };
  ASSERT_EQ(words_of(image), 1u);
  // One more bit in one channel of one texel, and all are kept as floats.
  Image finer = image;
  finer.rgb[0] = 255.5f;
  ASSERT_EQ(words_of(finer), 0u);
  const PackedLight light(image_scene(image, Mat4{}));
  const LightTables tables = light.tables();
  DS_GLOBAL float* p = tables.lights + PackedLight::at;
  DS_GLOBAL float* texels = tables.tables + as_uint(p[infinite_texels]);
  for (std::size_t i = 0; i < 8; ++i) {
    const real3 texel = infinite_texel(texels, true, static_cast<uint>(i));
    EXPECT_EQ(texel.x, image.rgb[3 * i]) << i;
    EXPECT_EQ(texel.y, image.rgb[3 * i + 1]) << i;
    EXPECT_EQ(texel.z, image.rgb[3 * i + 2]) << i;
  }
}

TEST(InfiniteLight, HasNoSeam) {
  const PackedLight light(image_scene(pictures::small_sky(), Mat4{}));
  for (double z = -0.99; z < 1; z += 0.03) {
    float pdf = 0;
    const real3 left =
        infinite_escape(light.tables(), PackedLight::at, direction(z, k_pi - 1e-5), &pdf);
    const real3 right =
        infinite_escape(light.tables(), PackedLight::at, direction(z, -k_pi + 1e-5), &pdf);
    EXPECT_NEAR(left.x, right.x, 1e-3 * (1 + double{left.x}));
  }
  for (const double z : {1.0, -1.0})
    for (double azimuth = -3; azimuth < 3; azimuth += 0.1) {
      float pdf = 0;
      const real3 pole = infinite_escape(light.tables(), PackedLight::at,
                                         direction(z * (1 - 1e-7), azimuth), &pdf);
      EXPECT_TRUE(pole.x >= 0 && pole.x < 1e4f && pdf >= 0 && std::isfinite(pdf));
    }
}

TEST(InfiniteLight, OddSizesStayWithinTheirTables) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 2}, {2, 1}, {3, 5}, {64, 1}}) {
    Image image;
    image.width = width;
    image.height = height;
    image.rgb.assign(static_cast<std::size_t>(3 * width * height), 1.0f);
    const PackedLight light(image_scene(image, Mat4{}));
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
      const float ends[3] = {0.0f, 0.99999994f, unit_interval(static_cast<uint>(random()))};
      const LightSample s = infinite_sample(light.tables(), PackedLight::at, vec(0, 0, 0),
                                            {ends[i % 3], ends[i / 3 % 3]});
      EXPECT_FLOAT_EQ(s.radiance.x, 1);
      float pdf = 0;
      for (const real3 d : {s.wi, vec(-1, 0, 0), vec(-1, -0.0f, 0), vec(0, 0, 1), vec(0, 0, -1)})
        EXPECT_FLOAT_EQ(infinite_escape(light.tables(), PackedLight::at, d, &pdf).x, 1);
    }
  }
}

TEST(InfiniteLight, ABlackImageIsNeverSampled) {
  Image image;
  image.width = 4;
  image.height = 2;
  image.rgb.assign(24, 0.0f);
  const PackedLight light(image_scene(image, Mat4{}));
  EXPECT_EQ(infinite_sample(light.tables(), PackedLight::at, vec(0, 0, 0), {0.3f, 0.6f}).pdf, 0);
  float pdf = 1;
  EXPECT_EQ(infinite_escape(light.tables(), PackedLight::at, vec(1, 0, 0), &pdf).x, 0);
  EXPECT_EQ(pdf, 0);
}

TEST(SunLight, IsAUniformDisc) {
  for (const double degrees : {0.265, 1.0, 30.0}) {
    Scene scene = lit_scene();
    scene.lights.push_back(pictures::sun_light({0.3f, -0.4f, 0.7f}, degrees, {5, 5, 5}));
    const PackedLight light(scene);
    const double one_minus_cos = 1 - double{*light_value(scene.lights[0], "cos_total")};
    const Vec3 towards = light_vector(scene.lights[0], "direction");
    const real3 centre = vec(towards.x, towards.y, towards.z);
    const Frame frame = frame_around(centre);
    std::vector<double> counts(128), expected(128, 100000 / 128.0);
    std::mt19937 random(2);
    int outside = 0;
    for (int i = 0; i < 100000; ++i) {
      const LightSample s = sun_sample(
          light.tables(), PackedLight::at, vec(0, 0, 0),
          {unit_interval(static_cast<uint>(random())), unit_interval(static_cast<uint>(random()))});
      EXPECT_NEAR(double{s.pdf} * 2 * k_pi * one_minus_cos, 1, 1e-6);
      float pdf = 0;
      sun_escape(light.tables(), PackedLight::at, s.wi, &pdf);
      if (pdf != s.pdf) ++outside;
      // 1 - cos from the chord, which keeps its bits.
      const real3 chord = sub(s.wi, centre);
      const double depth = std::min(double{dot(chord, chord)} / 2 / one_minus_cos, 0.999999);
      const real3 l = to_local(frame, s.wi);
      const double turn = std::min((std::atan2(double{l.y}, double{l.x}) / k_pi + 1) / 2, 0.999999);
      counts[static_cast<std::size_t>(depth * 8) * 16 + static_cast<std::size_t>(turn * 16)] += 1;
    }
    // Only on the rim, where a direction's rounding of 1e-7 decides.
    EXPECT_LT(outside, 100) << degrees;
    EXPECT_GT(chance_of_counts(counts, expected), 0.003) << degrees;
    float pdf = 1;
    EXPECT_EQ(sun_escape(light.tables(), PackedLight::at, negate(centre), &pdf).x, 0);
    EXPECT_EQ(pdf, 0);
  }
}

TEST(ConstantLight, IsNeverSampled) {
  Scene scene = lit_scene();
  scene.lights.push_back(pictures::constant_light({1, 2, 3}));
  const PackedLight light(scene);
  EXPECT_EQ(
      constant_infinite_sample(light.tables(), PackedLight::at, vec(0, 0, 0), {0.5f, 0.5f}).pdf, 0);
  float pdf = 1;
  EXPECT_EQ(constant_infinite_escape(light.tables(), PackedLight::at, vec(0, 1, 0), &pdf).y, 2);
  EXPECT_EQ(pdf, 0);
}

/// Van Oosterom and Strackee 1983.
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
  a = normalized(a), b = normalized(b), c = normalized(c);
  return 2 * std::atan2(std::fabs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

TEST(MeshLight, ItsPdfIntegratesToItsSolidAngle) {
  Scene scene;
  const int lamp = pictures::add_matte(scene, {0, 0, 0});
  scene.materials.back().emits = true;
  scene.materials.back().emission.constant = {7, 7, 7};
  Mesh mesh;
  // One large and one small triangle, and one without any area.
  mesh.positions = {{-1, -1, 2},  {-1, 1, 2},      {1, -1, 2.5f},
                    {1.2f, 1, 2}, {1.2f, 1.1f, 2}, {1.3f, 1, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {0, 0, 1}};
  pictures::add_object(scene, mesh, lamp);
  const PackedLight light(scene);
  double expected = 0;
  for (const auto& t : mesh.triangles)
    expected += solid_angle(to_double(mesh.positions[t[0]]), to_double(mesh.positions[t[1]]),
                            to_double(mesh.positions[t[2]]));
  std::mt19937 random(4);
  double sum = 0;
  int small = 0;
  constexpr int k_samples = 200000;
  for (int i = 0; i < k_samples; ++i) {
    const LightSample s = mesh_sample(
        light.tables(), PackedLight::at, vec(0, 0, 0),
        {unit_interval(static_cast<uint>(random())), unit_interval(static_cast<uint>(random()))});
    ASSERT_GT(s.pdf, 0);
    ASSERT_EQ(s.radiance.x, 7);
    ASSERT_LT(std::fabs(dot(s.wi, s.wi) - 1), 1e-5f);
    sum += 1 / double{s.pdf};
    small += s.target.x > 1.15f ? 1 : 0;
  }
  EXPECT_NEAR(sum / k_samples, expected, 3e-3 * expected);
  // By area: 0.005 of 2.067.
  EXPECT_NEAR(small / double{k_samples},
              0.005 / (0.005 + std::sqrt(2 * 2 * (2 * 2 + 0.5 * 0.5)) / 2), 4e-4);
  EXPECT_EQ(mesh_sample(light.tables(), PackedLight::at, vec(0, 0, 5), {0.2f, 0.2f}).pdf,
            0);  // from behind
}

TEST(UnmetLights, AreFoundByTheirSamplesAlone) {
  // Nothing else finds them: a sample that were weighed against the BSDF's would lose light.
  const auto check = [](std::string_view prefix, auto sample) {
    Scene scene = lit_scene();
    pictures::add_light(scene, prefix);
    const PackedLight light(scene);
    std::mt19937 random(8);
    int lit = 0;
    for (int i = 0; i < 1000; ++i) {
      const LightSample s = sample(light.tables(), PackedLight::at, vec(0.1f, -0.2f, 0),
                                   real2{unit_interval(static_cast<uint>(random())),
                                         unit_interval(static_cast<uint>(random()))});
      ASSERT_TRUE(s.pdf >= 0) << prefix;
      if (s.pdf == 0) continue;
      ++lit;
      EXPECT_TRUE(s.dirac) << prefix;
      EXPECT_EQ(s.pdf, 1) << prefix;
      EXPECT_NEAR(dot(s.wi, s.wi), 1, 1e-6f) << prefix;
      EXPECT_GT(s.wi.z, 0) << prefix;
    }
    EXPECT_GT(lit, 500) << prefix;
  };
#define DS_CHECK(sdl_name, prefix) \
  check(#prefix, [](auto... arguments) { return prefix##_sample(arguments...); });
  DS_UNMET_LIGHTS(DS_CHECK)
#undef DS_CHECK
}

TEST(UniformTriangle, IsUniform) {
  std::mt19937 random(5);
  std::vector<double> counts(100), expected(100, 1000);
  for (int i = 0; i < 100000; ++i) {
    const real2 b = uniform_triangle(
        {unit_interval(static_cast<uint>(random())), unit_interval(static_cast<uint>(random()))});
    ASSERT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1.000001f);
    // Undoes b = (1 - r, s r), r = sqrt of a uniform number.
    const double r = 1 - double{b.x};
    counts[static_cast<std::size_t>(std::min(r * r, 0.999999) * 10) * 10 +
           static_cast<std::size_t>(std::min(double{b.y} / r, 0.999999) * 10)] += 1;
  }
  EXPECT_GT(chance_of_counts(counts, expected), 0.01);
}

TEST(FindInterval, EqualsALinearSearch) {
  std::mt19937 random(6);
  for (uint count = 1; count < 70; ++count) {
    std::vector<float> table;
    for (uint i = 0; i < count; ++i)
      table.push_back(static_cast<float>(random() % 16) / 16);
    std::sort(table.begin(), table.end());
    table.back() = 1;
    for (int i = 0; i <= 64; ++i) {
      const float u = std::min(static_cast<float>(i) / 64, 0.99999994f);
      const auto first =
          static_cast<uint>(std::upper_bound(table.begin(), table.end(), u) - table.begin());
      ASSERT_EQ(find_interval(table.data(), 0, count, u), std::min(first, count - 1))
          << count << " " << u;
    }
  }
}

}  // namespace
}  // namespace ds

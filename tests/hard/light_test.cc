// SPDX-License-Identifier: Apache-2.0
// Lights, glass, mirrors, films and depths at the ends of their ranges, against closed forms.
#include "tests/hard/everywhere.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace ds {
namespace {

using pictures::Picture;

constexpr double k_pi = std::numbers::pi;

/// A few pixels on the plane z = 0 of reflectance 0.5, seen from straight above.
Picture on_a_plane(const std::string& name, double fov_deg, int pixels = 8, int spp = 64) {
  Picture p = hard::deep_picture(pixels, spp);
  p.name = name;
  pictures::add_object(p.scene, pictures::quad({}, {9, 0, 0}, {0, 9, 0}),
                       pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
  p.camera.position = {0, 0, 2};
  p.camera.up = {0, 1, 0};
  p.camera.fov_deg = fov_deg;
  return p;
}

TEST(Mirror, SixtyFourBounces) {
  // Between mirrors one apart, upwards at 45 degrees from the middle of the gap to x = 64.
  Picture p = hard::deep_picture(2, 16);
  p.name = "64 bounces";
  const int mirror = pictures::add_material(p.scene, "mirror");
  pictures::set_input(p.scene, mirror, "kr", {0.9f, 0.9f, 0.9f});
  for (const float z : {0.0f, 1.0f})
    pictures::add_object(p.scene, pictures::quad({31, 0, z}, {33, 0, 0}, {0, 5, 0}), mirror);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0, 0, 0.5};
  p.camera.target = {1, 0, 1.5};
  p.camera.fov_deg = 0.01;
  const double expected = std::pow(double{0.9f}, 64);
  hard::everywhere(p, [&](const Film& film) {
    // 64 products of relative error 2^-24 each.
    EXPECT_LT(hard::worst_difference(film, expected), 1e-5 * expected);
  });
}

TEST(Glass, IndexMatchedCannotBeSeen) {
  Picture p = hard::deep_picture(12, 16);
  p.name = "index-matched glass";
  p.scene.images.push_back(pictures::small_sky());
  p.scene.lights.push_back(pictures::image_light(0));
  p.camera.position = {0.2, -3, 0.4};
  Picture without = p;
  const int glass = pictures::add_material(p.scene, "glass");
  pictures::set_input(p.scene, glass, "interiorior", {1.33f, 0, 0});
  pictures::set_input(p.scene, glass, "exteriorior", {1.33f, 0, 0});
  pictures::add_object(p.scene, pictures::sphere({}, 1, 24, true), glass);
  // Something must stand somewhere: behind the camera.
  pictures::add_object(without.scene, pictures::quad({0, -9, 0}, {0.1f, 0, 0}, {0, 0, 0.1f}),
                       pictures::add_matte(without.scene, {0, 0, 0}));
  const Film sky = hard::trace(without, {});
  hard::everywhere(p, [&](const Film& film) {
    for (std::size_t i = 0; i < film.rgb.size(); ++i)
      // Two refractions turn a direction by a few 1e-7; the sky's steepest texel is a thousand
      // times its neighbour.
      ASSERT_NEAR(film.rgb[i], sky.rgb[i], 2e-3f * (1 + sky.rgb[i]));
  });
}

TEST(Glass, NestedCannotBeSeenInAFurnace) {
  // Glass, in it a bubble of air, in that glass of a higher index; what goes in comes out.
  Picture p = hard::deep_picture(12, 16);
  p.name = "nested glass";
  const std::array<std::array<float, 3>, 3> shells = {
      {{1, 1.5f, 1}, {0.6f, 1, 1.5f}, {0.3f, 2.4f, 1}}};
  for (const auto& [radius, inside, outside] : shells) {
    const int glass = pictures::add_material(p.scene, "glass");
    pictures::set_input(p.scene, glass, "interiorior", {inside, 0, 0});
    pictures::set_input(p.scene, glass, "exteriorior", {outside, 0, 0});
    pictures::add_object(p.scene, pictures::sphere({}, radius, 16, false), glass);
  }
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.3, -3, 0.5};
  hard::everywhere(p, [](const Film& film) {
    // Paths are 1 or, trapped by total reflection for a thousand bounces, 0.
    EXPECT_NEAR(hard::mean_of(film), 1, 5e-3);
    EXPECT_LT(*std::max_element(film.rgb.begin(), film.rgb.end()), 1 + 1e-5f);
  });
}

TEST(Roughness, OfNothingIsTheLeastThereIs) {
  for (const std::string& material : hard::materials(true)) {
    const int row = find_type(material_types(), material);
    const NodeType& type = material_types()[static_cast<std::size_t>(row)];
    if (find_input(type, "uroughness") < 0) continue;
    std::vector<Film> films;
    for (const float roughness : {0.0f, 1e-9f, 1.0f}) {
      Picture p = hard::deep_picture(12, 32);
      p.name = material + " of roughness " + std::to_string(roughness);
      const int m = hard::add_material(p.scene, material);
      for (const char* input : {"uroughness", "vroughness"})
        pictures::set_input(p.scene, m, input, {roughness, 0, 0});
      pictures::add_object(p.scene, pictures::sphere({}, 1, 24, true), m);
      p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      p.camera.position = {0.6, -1.7, 0.8};
      p.camera.fov_deg = 20;
      hard::everywhere(p, [](const Film& film) {
        EXPECT_LT(hard::mean_of(film), 1.005);
        EXPECT_GT(hard::mean_of(film), 0.1);
      });
      films.push_back(hard::trace(p, {}));
    }
    EXPECT_EQ(films[0].rgb, films[1].rgb) << material;
    if (has_trait(type, kernels::k_trait_transmits)) {
      // What needs several facets is lost at each of the path's surfaces.
      EXPECT_LT(hard::mean_of(films[2]), hard::mean_of(films[0])) << material;
      continue;
    }
    // A rough one reflects what a smooth one does, but for what glossy2's base (0.5) takes of the
    // light that its facets send on.
    EXPECT_NEAR(hard::mean_of(films[2]), hard::mean_of(films[0]), 0.15) << material;
  }
}

TEST(Roughness, UnequalOnAMeshWithoutUv) {
  // LuxCore takes the direction of anisotropy from dp/du, which such a mesh lacks; here it comes
  // from the normal alone.
  Picture p = hard::deep_picture(16, 64);
  p.name = "unequal roughness";
  const std::vector<int> all = hard::add_white_materials(p.scene, 0.05f, 0.5f);
  Mesh mesh = pictures::sphere({}, 1, 24, true);
  hard::add_patches(p.scene, mesh, all);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.6, -2.4, 0.8};
  p.camera.fov_deg = 40;
  const Film with_uv = hard::trace(p, {});
  for (Object& object : p.scene.objects)
    object.mesh.uvs.clear();
  hard::everywhere(p, [](const Film& film) {
    // Half of the body is white lobes of 0.05 by 0.5. The fits are of equal roughnesses and stay
    // below: 0.82 comes back at the least (20,000 samples a direction on the host), never above 1.
    EXPECT_LT(hard::mean_of(film), 1.005);
    EXPECT_GT(hard::mean_of(film), 0.91);
  });
  EXPECT_EQ(hard::trace(p, {}).rgb, with_uv.rgb);
}

TEST(Mix, WholeFurnaces) {
  // Kd = 0.25 and Kr = 0.5, as a mix in equal shares of a matte of 0.5 and a mirror of 1: in a
  // closed box whose walls shine 0.25, L = 0.25 + 0.75 L = 1 (pbrt integrators_test); a convex body
  // under a sky of 1 shows 0.75.
  const auto add = [](Scene& scene) {
    const int matte = pictures::add_matte(scene, {0.5f, 0.5f, 0.5f});
    return hard::add_mix(scene, matte, pictures::add_material(scene, "mirror"));
  };
  Picture box = hard::deep_picture(8, 256, 4);
  box.name = "shining box of a mix";
  const int wall = add(box.scene);
  box.scene.materials.back().emits = true;
  box.scene.materials.back().emission.constant = {0.25f, 0.25f, 0.25f};
  pictures::add_object(box.scene, pictures::inside_out(pictures::box({}, {1, 0.8f, 0.6f})), wall);
  box.camera.position = {0.3, -0.4, 0.2};
  Picture sphere = hard::deep_picture(8, 256);
  sphere.name = "sphere of a mix";
  pictures::add_object(sphere.scene, pictures::sphere({}, 1, 12, false), add(sphere.scene));
  sphere.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  sphere.camera.position = {0.6, -1.7, 0.8};
  sphere.camera.fov_deg = 20;
  // 16,384 samples. A path's sum in the box has a standard deviation of about 0.7: 5 sigma. One on
  // the sphere is 0.5 or 1.
  hard::everywhere(box, [](const Film& film) { EXPECT_NEAR(hard::mean_of(film), 1, 0.025); });
  hard::everywhere(sphere, [](const Film& film) { EXPECT_NEAR(hard::mean_of(film), 0.75, 0.01); });
}

/// The plane of on_a_plane of another material, as rough as can be.
Picture on_a_plane_of(const std::string& material, const std::string& name, int pixels, int spp) {
  Picture p = on_a_plane(name + " on " + material, 1, pixels, spp);
  p.scene.objects[0].material = hard::add_material(p.scene, material);
  for (std::size_t m = 0; m < p.scene.materials.size(); ++m)
    hard::set_alpha(p.scene, static_cast<int>(m), 1);
  return p;
}

TEST(ImageLight, OneTexelOfAMillion) {
  // Light adds up: what a texel of 1e6 adds is a thousand times what one of 1e3 adds, and that is
  // held to a closed form for matte by DirectLight.ImageOnAPlane.
  const auto radiance = [](const std::string& material, const hard::Way& way, float brightest) {
    Picture p = on_a_plane_of(material, "texel", 8, 64);
    p.scene.images.push_back(pictures::small_sky());
    for (float& v : p.scene.images[0].rgb)
      v = v > 50 ? brightest : v;
    p.scene.lights.push_back(pictures::image_light(0));
    return hard::estimate(p, way, 12);
  };
  for (const std::string& material : hard::materials(false))
    for (const hard::Way& way : hard::full_program_ways()) {
      const pictures::Estimate none = radiance(material, way, 0);
      const pictures::Estimate thousand = radiance(material, way, 1e3f);
      const pictures::Estimate million = radiance(material, way, 1e6f);
      const double expected = none.mean + 1000 * (thousand.mean - none.mean);
      EXPECT_NEAR(
          million.mean, expected,
          4 * std::hypot(million.error, 1000 * thousand.error, 1000 * none.error) + 1e-4 * expected)
          << material << ", " << way.name();
      EXPECT_LT(million.error, 0.02 * million.mean) << material << ", " << way.name();
    }
}

TEST(ImageLight, BlackIsBlack) {
  // LuxCore throws.
  Image black;
  black.width = 4;
  black.height = 2;
  black.rgb.assign(24, 0.0f);
  const auto under_black = [&](Picture p) {
    p.scene.images.push_back(black);
    p.scene.lights.push_back(pictures::image_light(0));
    return p;
  };
  const auto expect_black = [](const Film& film) { EXPECT_EQ(hard::mean_of(film), 0.0); };
  hard::everywhere(under_black(on_a_plane("black sky", 40)), expect_black);
  for (const std::string& material : hard::materials(true))
    for (const hard::Way& way : hard::full_program_ways())
      expect_black(hard::trace(under_black(on_a_plane_of(material, "black sky", 8, 64)), way));
}

/// A sun of radius 0.265 degrees so far over the plane, at y = 0, of radiance 1e4.
Light low_sun(double elevation_deg) {
  const double e = elevation_deg * k_pi / 180;
  return pictures::sun_light({static_cast<float>(std::cos(e)), 0, static_cast<float>(std::sin(e))},
                             0.265, {1e4f, 1e4f, 1e4f});
}

/// Radiance that the part of the disc above the ground sends up from it, by a fine sum over rows of
/// the disc; `value` is the BSDF times the cosine at the sine of a row's height.
double from_what_is_above(const Light& sun, const std::function<double(double)>& value) {
  const double radius = std::acos(double{*light_value(sun, "cos_total")});
  const double height = std::asin(double{light_vector(sun, "direction").z});
  double sum = 0;
  constexpr int k_rows = 20000;
  for (int i = 0; i < k_rows; ++i) {
    // The disc is so small that it is flat: a row at y over its centre is 2 sqrt(r^2 - y^2) wide.
    const double y = radius * (2 * (i + 0.5) / k_rows - 1);
    const double sine = std::sin(height + y);
    if (sine > 0)
      sum += value(sine) * 2 * std::sqrt(radius * radius - y * y) * (2 * radius / k_rows);
  }
  return 1e4 * sum;
}

// Its centre is 0.05 and 0.2 degrees over the plane, and once all of it.
constexpr std::array k_elevations_deg = {0.05, 0.2, 1.0};

TEST(Sun, HalfBelowTheGroundLightsItByTheHalfAbove) {
  for (const double elevation_deg : k_elevations_deg) {
    Picture p = on_a_plane("sun at " + std::to_string(elevation_deg), 1, 8, 1024);
    p.scene.lights.push_back(low_sun(elevation_deg));
    const double expected =
        from_what_is_above(p.scene.lights[0], [](double sine) { return 0.5 / k_pi * sine; });
    hard::everywhere(p, [&](const Film& film) {
      // 65,536 stratified samples: below 0.4 % even if they were independent.
      EXPECT_NEAR(hard::mean_of(film), expected, 0.02 * expected);
    });
  }
}

TEST(Sun, HalfBelowTheGroundLightsEveryMaterial) {
  // The BSDF of kernels/ on the host, summed over the disc.
  for (const materials::Case& material : materials::all())
    for (const double elevation_deg : k_elevations_deg) {
      Picture p = on_a_plane_of(std::string(material.name), "sun", 8, 256);
      p.scene.lights.push_back(low_sun(elevation_deg));
      const std::vector<float> inputs = materials::inputs(material, 1);
      const double expected = from_what_is_above(p.scene.lights[0], [&](double sine) {
        const kernels::real3 wi = kernels::vec(static_cast<float>(std::sqrt(1 - sine * sine)), 0,
                                               static_cast<float>(sine));
        return double{material.evaluate(inputs.data(), materials::viewer(1), wi).value.x};
      });
      for (const hard::Way& way : hard::full_program_ways())
        EXPECT_NEAR(hard::mean_of(hard::trace(p, way)), expected, 0.02 * expected)
            << p.name << " at " << elevation_deg << ", " << way.name();
    }
}

TEST(Spot, ASharpEdge) {
  // Equal inner and outer angle: full strength inside, nothing outside, never NaN between.
  const auto lit_at = [](double x) {
    Picture p = on_a_plane("spot's edge at " + std::to_string(x), 0.05, 4, 16);
    p.scene.lights.push_back(pictures::spot_light({0, 0, 1}, {0, 0, -1}, 30, 30, {3, 3, 3}));
    p.camera.position = {x, 0, 0.9};
    p.camera.target = {x, 0, 0};
    return p;
  };
  const double edge = std::tan(30 * k_pi / 180);
  for (const double x : {0.0, 0.3, edge - 0.002}) {
    // scene.h: intensity over the cosine of the angle a; at distance 1 / cos a, cosine cos a.
    const double expected = 0.5 / k_pi * 3 * std::pow(1 + x * x, -1);
    hard::everywhere(lit_at(x), [&](const Film& film) {
      EXPECT_LT(hard::worst_difference(film, expected), 2e-3 * expected);
    });
  }
  hard::everywhere(lit_at(edge + 0.002),
                   [](const Film& film) { EXPECT_EQ(hard::mean_of(film), 0); });
  hard::everywhere(lit_at(edge), [](const Film&) {});
}

Picture glowing_box(double emission, double kd) {
  Picture p = hard::deep_picture(4, 8);
  p.name = "glowing box";
  const int wall = pictures::add_matte(
      p.scene, {static_cast<float>(kd), static_cast<float>(kd), static_cast<float>(kd)});
  const auto e = static_cast<float>(emission);
  p.scene.materials[0].emits = true;
  p.scene.materials[0].emission.constant = {e, e, e};
  pictures::add_object(p.scene, pictures::inside_out(pictures::box({}, {1, 0.8f, 0.6f})), wall);
  p.camera.position = {0.3, -0.4, 0.2};
  return p;
}

TEST(Film, DepthZeroShowsWhatShines) {
  Picture p = glowing_box(0.75, 0.5);
  p.engine.depth_total = 0;
  hard::everywhere(p,
                   [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.75), 1e-6); });
}

TEST(Film, DepthOneAddsOneReflection) {
  Picture p = glowing_box(0.75, 0.5);
  p.engine.depth_total = 1;
  p.engine.spp = 1024;
  hard::everywhere(p, [](const Film& film) {
    // L = Le + kd Le; 16,384 samples of a standard deviation below 0.5.
    EXPECT_NEAR(hard::mean_of(film), 0.75 * 1.5, 0.02);
  });
}

TEST(Film, OfOnePixelAndOneSample) {
  for (const int spp : {1, 2, 3})
    for (const float filter : {0.0f, 3.0f}) {
      Picture p = on_a_plane("one pixel", 40, 1, spp);
      p.engine.filter_width = filter;
      p.scene.lights.push_back(pictures::constant_light({1, 2, 3}));
      hard::everywhere(p, [&](const Film& film) {
        EXPECT_EQ(film.rgb.size(), 3u);
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(film.rgb[c], 0.5f * static_cast<float>(c + 1), 1e-6f);
        EXPECT_EQ(film.relative_error.has_value(), spp > 1);
      });
    }
}

TEST(Film, OddShapes) {
  for (const auto& [width, height] : {std::pair{1, 17}, {17, 1}, {9, 7}}) {
    Picture p = on_a_plane("odd shape", 40);
    p.engine.width = width;
    p.engine.height = height;
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    hard::everywhere(p,
                     [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
  }
}

TEST(Film, AMillionSamplesOfATenthSumToATenth) {
  // Without compensation a sum of floats stands still at 2^24 of its addend and is off by 1e-3
  // before.
  Picture p = hard::deep_picture(1, 1 << 20);
  p.name = "a million samples";
  pictures::add_object(p.scene, pictures::quad({0, 0, -9}, {1, 0, 0}, {0, 1, 0}),
                       pictures::add_matte(p.scene, {0, 0, 0}));
  p.scene.lights.push_back(pictures::constant_light({0.1f, 0.2f, 0.7f}));
  p.camera.position = {0, 0, 1};
  p.camera.target = {1, 0, 1};
  for (const hard::Way& way : {hard::Way{}, hard::Way{MathMode::strict, 1, true}}) {
    const Film film = hard::trace(p, way);
    EXPECT_FLOAT_EQ(film.rgb[0], 0.1f);
    EXPECT_FLOAT_EQ(film.rgb[1], 0.2f);
    EXPECT_FLOAT_EQ(film.rgb[2], 0.7f);
  }
}

TEST(Lens, ANanometreIsAPinhole) {
  Picture p = on_a_plane("lens", 40);
  p.scene.lights.push_back(pictures::point_light({0.3f, 0.2f, 1}, {3, 3, 3}));
  const double pinhole = hard::mean_of(hard::trace(p, {}));
  p.camera.lens_radius_m = 1e-9;
  p.camera.focus_distance_m = 2;
  hard::everywhere(
      p, [&](const Film& film) { EXPECT_NEAR(hard::mean_of(film), pinhole, 1e-4 * pinhole); });
}

/// The brightest value over the mean, of this picture's 256 samples a pixel in strict arithmetic;
/// 8.61 of 4096 samples. README.md has it too.
constexpr double k_recorded_max_over_mean = 12.88;

TEST(Firefly, ACausticUnderASmallLampKeepsItsMean) {
  // The lamp is found through the glass by chance only. No clamp: samples far above the mean are
  // right, and four times as many agree with a quarter as many.
  Picture p = on_a_plane("caustic", 40, 12, 64);
  p.engine.depth_total = 12;
  pictures::add_object(p.scene, pictures::sphere({0.1f, 0, 0.45f}, 0.4f, 24, true),
                       pictures::add_material(p.scene, "glass"));
  const int lamp = pictures::add_matte(p.scene, {0, 0, 0});
  p.scene.materials.back().emits = true;
  p.scene.materials.back().emission.constant = {400, 400, 400};
  pictures::add_object(p.scene, pictures::quad({-0.4f, 0.2f, 1.6f}, {0.05f, 0, 0}, {0, -0.05f, 0}),
                       lamp);
  Picture more = p;
  more.engine.spp *= 4;
  // How bright the caustic is where it is brightest, from 4096 samples a pixel of another seed.
  Picture reference = p;
  reference.engine.spp = 4096;
  reference.engine.seed = 0xfeedfeedfeedfeedu;
  const Film converged = hard::trace(reference, {});
  for (const hard::Way& way : {hard::Way{}, hard::Way{MathMode::fast, 1, true}}) {
    const pictures::Estimate few = hard::estimate(p, way, 16);
    const pictures::Estimate many = hard::estimate(more, way, 16, 1000);
    EXPECT_NEAR(few.mean, many.mean, 4 * std::hypot(few.error, many.error)) << way.name();
    const Film film = hard::trace(more, way);
    EXPECT_EQ(film.rejected_samples, 0u);
    // A sample is at most what the plane (0.5) makes of the lamp's 400, so a pixel that is m in
    // truth has a variance of at most 200 m / spp. 5 sigma: one picture of 144 pixels in 10,000.
    for (std::size_t i = 0; i < film.rgb.size(); ++i) {
      const double truth = double{converged.rgb[i]};
      const double error = std::sqrt(200 * std::max(truth, 0.02) / more.engine.spp);
      EXPECT_LT(film.rgb[i], truth + 5 * error) << way.name() << ", value " << i;
    }
    const double ratio =
        double{*std::max_element(film.rgb.begin(), film.rgb.end())} / hard::mean_of(film);
    // More would say that a light or a way to it is sampled worse than it was.
    EXPECT_LT(ratio, 1.05 * k_recorded_max_over_mean) << way.name();
  }
}

}  // namespace
}  // namespace ds

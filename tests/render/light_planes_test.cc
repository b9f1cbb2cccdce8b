// SPDX-License-Identifier: Apache-2.0
// Planes of light: shares of a picture by the first surface's lobes and what lit it.
#include "tests/render/bits.h"
#include "tests/render/pictures.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/device/plane_types.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>

namespace ds {
namespace {

using pictures::Picture;

constexpr double k_pi = std::numbers::pi;

/// Those that add up to the picture.
std::vector<const PlaneType*> all_types() {
  std::vector<const PlaneType*> types;
  for (const PlaneType& type : plane_types())
    if (is_of_light(type) && (type.traits & kernels::k_plane_beside) == 0) types.push_back(&type);
  return types;
}

LitPlanes trace_light(const Picture& picture, const std::vector<const PlaneType*>& types) {
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(picture.scene);
  return tracer.trace_light(picture.camera, picture.engine, types);
}

/// Mean of each plane's three channels over all pixels.
std::map<std::string, Vec3d> means(const LitPlanes& traced) {
  std::map<std::string, Vec3d> means;
  for (const Plane& plane : traced.planes) {
    Vec3d sum{};
    for (std::size_t i = 0; i < plane.values.size(); i += 3)
      sum = sum + to_double(Vec3{plane.values[i], plane.values[i + 1], plane.values[i + 2]});
    means[std::string(plane.type->name)] = (3.0 / static_cast<double>(plane.values.size())) * sum;
  }
  return means;
}

void expect_sum(const LitPlanes& traced, const std::string& name) {
  const std::vector<float>& picture = traced.film.rgb;
  int lit = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    double sum = 0;
    for (const Plane& plane : traced.planes) {
      ASSERT_EQ(plane.values.size(), picture.size());
      ASSERT_GE(plane.values[i], 0.0f) << plane.type->name;
      sum += double{plane.values[i]};
    }
    // A few roundings for each sample's vertices and for its shares; those of many samples cancel.
    ASSERT_NEAR(sum, double{picture[i]}, 2e-6 * double{picture[i]} + 1e-30) << name << " " << i;
    lit += picture[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(lit, static_cast<int>(picture.size()) / 2) << name;
}

// Every material, texture and light, mixes, a lens, what the camera does not see.
TEST(LightPlanes, AddUpToThePictureAndMoveNoBitOfIt) {
  for (Picture picture : pictures::all_effects()) {
    const LitPlanes traced = trace_light(picture, all_types());
    EXPECT_EQ(pictures::film_hash(traced.film), pictures::film_hash(pictures::trace(picture)))
        << picture.name;
    expect_sum(traced, picture.name);
    for (const auto& [plane, mean] : means(traced))
      EXPECT_TRUE(mean.x > 0 || picture.name != "everything") << plane;
  }
}

std::vector<const PlaneType*> cut_types() {
  return {&plane_type("alpha"), &plane_type("foreground"), &plane_type("emission")};
}

// What is covered by a matte of kd 1 in a white sky of 0.5 shines 0.5, with or without the sky behind; the
// sky's own pixels have no foreground. A lens, so that edges are soft.
TEST(LightPlanes, AlphaAndForegroundLeaveOutWhatIsInfinitelyFar) {
  Picture picture;
  picture.camera.position = {0, 0, 3};
  picture.camera.fov_deg = 30;
  picture.camera.lens_radius_m = 0.05;
  picture.camera.focus_distance_m = 2;
  picture.engine.width = picture.engine.height = 32;
  picture.engine.spp = 64;
  picture.engine.seed = pictures::wide_seed(11);
  picture.engine.roulette_depth = 255;
  const int white = pictures::add_material(picture.scene, "matte");
  pictures::set_input(picture.scene, white, "kd", {1, 1, 1});
  pictures::add_object(picture.scene, pictures::quad({0, 0, 0}, {0.4f, 0, 0}, {0, 0.4f, 0}), white);
  picture.scene.lights = {pictures::constant_light({0.5f, 0.5f, 0.5f})};
  const LitPlanes traced = trace_light(picture, cut_types());
  EXPECT_EQ(pictures::film_hash(traced.film), pictures::film_hash(pictures::trace(picture)));
  const std::vector<float>& alpha = traced.planes[0].values;
  const std::vector<float>& foreground = traced.planes[1].values;
  const std::vector<float>& emission = traced.planes[2].values;
  ASSERT_EQ(alpha.size(), 32u * 32u);
  ASSERT_EQ(foreground.size(), 3 * alpha.size());
  int whole = 0, none = 0, between = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    ASSERT_GE(alpha[i], 0.0f);
    ASSERT_LE(alpha[i], 1.0f + 1e-6f);
    // One quad scatters light away from itself once, so all that covers shines as the sky does.
    EXPECT_NEAR(foreground[3 * i], 0.5f * alpha[i], 1e-5f) << i;
    EXPECT_NEAR(emission[3 * i], 0.5f * (1 - alpha[i]), 1e-5f) << i;
    (alpha[i] > 1 - 1e-5f ? whole : alpha[i] < 1e-5f ? none : between) += 1;
  }
  EXPECT_EQ(alpha[16 * 32 + 16], 1.0f);
  // The quad is 0.8 wide 3 in front of a field 1.61 wide: 0.247 of it.
  double mean = 0;
  for (const float one : alpha)
    mean += double{one} / static_cast<double>(alpha.size());
  EXPECT_NEAR(mean, 0.64 / (4 * 9 * 0.0717968), 0.01);
  EXPECT_GT(whole, 100);
  EXPECT_GT(none, 500);
  EXPECT_GT(between, 40);
}

// Over what was left out there stands the picture, whatever is in it; a lamp that the camera sees covers.
TEST(LightPlanes, ForegroundAndTheSkyBehindAreThePicture) {
  for (Picture picture : pictures::all_effects()) {
    const LitPlanes traced = trace_light(picture, cut_types());
    EXPECT_EQ(pictures::film_hash(traced.film), pictures::film_hash(pictures::trace(picture)))
        << picture.name;
    for (std::size_t i = 0; i < traced.film.rgb.size(); ++i) {
      const double whole = double{traced.film.rgb[i]}, front = double{traced.planes[1].values[i]};
      ASSERT_LE(front, whole * (1 + 2e-6) + 1e-30) << picture.name << " " << i;
      ASSERT_GE(front + double{traced.planes[2].values[i]}, whole * (1 - 2e-6)) << picture.name;
      if (traced.planes[0].values[i / 3] == 0.0f) {
        ASSERT_EQ(front, 0.0) << picture.name << " " << i;
      }
    }
  }
}

TEST(LightPlanes, AlphaIsOfWholeSamplesWhereTheirLightIsScaledDown) {
  Picture picture = pictures::all_effects().front();
  const LitPlanes plain = trace_light(picture, cut_types());
  picture.engine.outlier_limit = 0.1f;
  const LitPlanes scaled = trace_light(picture, cut_types());
  EXPECT_GT(scaled.film.facts.outlier_samples, 100u);
  EXPECT_EQ(plain.planes[0].values, scaled.planes[0].values);
}

TEST(LightPlanes, AddUpWhereSamplesAreScaledDownAndTilesHaveTheirOwnNumbers) {
  Picture picture = pictures::all_effects().front();
  picture.engine.outlier_limit = 0.1f;
  LitPlanes traced = trace_light(picture, all_types());
  EXPECT_GT(traced.film.facts.outlier_samples, 100u);
  expect_sum(traced, "scaled down");
  picture.engine.outlier_limit = 0;
  picture.engine.target = ErrorTarget{0.05, 64, picture.scene.tone_map};
  traced = trace_light(picture, all_types());
  EXPECT_LT(traced.film.facts.least_spp, traced.film.facts.most_spp);
  EXPECT_EQ(pictures::film_hash(traced.film), pictures::film_hash(pictures::trace(picture)));
  expect_sum(traced, "by an error target");
}

Picture small_picture(int spp) {
  Picture picture;
  picture.camera.position = {0.2, -0.6, 1.8};
  picture.camera.fov_deg = 0.2;
  picture.engine.width = picture.engine.height = 8;
  picture.engine.spp = spp;
  picture.engine.seed = pictures::wide_seed(5);
  picture.engine.roulette_depth = 255;
  return picture;
}

/// A coated floor with a wall of the same beside it.
Picture corner(int spp) {
  Picture picture = small_picture(spp);
  const int coated = pictures::add_material(picture.scene, "glossy2");
  pictures::set_input(picture.scene, coated, "kd", {0.7f, 0.4f, 0.2f});
  pictures::set_input(picture.scene, coated, "ks", {0.1f, 0.2f, 0.3f});
  pictures::set_input(picture.scene, coated, "uroughness", {0.3f, 0.3f, 0.3f});
  pictures::set_input(picture.scene, coated, "vroughness", {0.3f, 0.3f, 0.3f});
  pictures::add_object(picture.scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), coated);
  pictures::add_object(picture.scene, pictures::quad({0, 0.3f, 0.5f}, {1, 0, 0}, {0, 0, 0.5f}),
                       coated);
  return picture;
}

TEST(LightPlanes, HaveTheSameBitsAloneAndInAnyOrder) {
  Picture picture = corner(4);
  picture.scene.lights = {pictures::point_light({0.3f, -0.5f, 1}, {1, 1, 1}),
                          pictures::constant_light({0.5f, 0.4f, 0.3f})};
  const auto bits = [](const Plane& plane) {
    std::vector<std::uint32_t> words;
    for (const float value : plane.values)
      words.push_back(std::bit_cast<std::uint32_t>(value));
    return words;
  };
  std::vector<const PlaneType*> types = all_types();
  const LitPlanes together = trace_light(picture, types);
  std::reverse(types.begin(), types.end());
  const LitPlanes reversed = trace_light(picture, types);
  for (std::size_t i = 0; i < types.size(); ++i) {
    const Plane& plane = together.planes[types.size() - 1 - i];
    ASSERT_EQ(plane.type, types[i]);
    EXPECT_EQ(bits(reversed.planes[i]), bits(plane)) << plane.type->name;
    const LitPlanes alone = trace_light(picture, {types[i]});
    EXPECT_EQ(bits(alone.planes.front()), bits(plane)) << plane.type->name;
    EXPECT_EQ(pictures::film_hash(alone.film), pictures::film_hash(together.film));
  }
}

void expect_only(const Picture& picture, const std::map<std::string, Vec3d>& lit,
                 double tolerance) {
  for (const auto& [name, mean] : means(trace_light(picture, all_types()))) {
    const auto found = lit.find(name);
    const Vec3d right = found == lit.end() ? Vec3d{} : found->second;
    EXPECT_NEAR(mean.x, right.x, tolerance * right.x) << name;
    EXPECT_NEAR(mean.y, right.y, tolerance * right.y) << name;
    EXPECT_NEAR(mean.z, right.z, tolerance * right.z) << name;
  }
}

TEST(LightPlanes, OfAMatteFloorUnderAPoint) {
  Picture picture = small_picture(4);
  pictures::add_object(picture.scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                       pictures::add_matte(picture.scene, {0.8f, 0.5f, 0.2f}));
  picture.scene.lights = {pictures::point_light({0, 0.4f, 0.3f}, {1, 2, 3})};
  const double irradiance = 0.3 / std::pow(0.3 * 0.3 + 0.4 * 0.4, 1.5);  // cosine over distance^2
  expect_only(picture, {{"direct_diffuse", (irradiance / k_pi) * Vec3d{0.8 * 1, 0.5 * 2, 0.2 * 3}}},
              1e-3);
}

TEST(LightPlanes, OfAMirrorAndOfTheSkyBesideIt) {
  Picture picture = small_picture(4);
  const int mirror = pictures::add_material(picture.scene, "mirror");
  pictures::set_input(picture.scene, mirror, "kr", {0.5f, 0.25f, 0.125f});
  pictures::add_object(picture.scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), mirror);
  picture.scene.lights = {pictures::constant_light({2, 3, 4})};
  expect_only(picture, {{"indirect_specular", {1, 0.75, 0.5}}}, 1e-6);
  // What is lit stays what the mirror shows.
  pictures::add_object(picture.scene, pictures::quad({0, 0, 3}, {9, 0, 0}, {0, 9, 0}),
                       pictures::add_matte(picture.scene, {0, 0, 0}));
  picture.scene.materials.back().emits = true;
  picture.scene.materials.back().emission.constant = {4, 8, 16};
  expect_only(picture, {}, 1e-6);  // its back
  picture.scene.objects.back().mesh = pictures::inside_out(picture.scene.objects.back().mesh);
  expect_only(picture, {{"indirect_specular", {2, 2, 2}}}, 1e-6);
  picture.camera.target = {0, 0, 9};
  expect_only(picture, {{"emission", {4, 8, 16}}}, 1e-6);
  picture.camera.position = {0.1, 0.2, 4};
  expect_only(picture, {{"emission", {2, 3, 4}}}, 1e-6);
}

TEST(LightPlanes, OfARoughMetalAreGlossy) {
  Picture picture = small_picture(64);
  const int metal = pictures::add_material(picture.scene, "metal2");
  pictures::add_object(picture.scene, pictures::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), metal);
  picture.scene.lights = {pictures::constant_light({1, 1, 1}),
                          pictures::point_light({0.4f, 0.3f, 0.5f}, {1, 1, 1})};
  const std::map<std::string, Vec3d> found = means(trace_light(picture, all_types()));
  for (const auto& [name, mean] : found)
    EXPECT_EQ(mean.x > 0, name == "direct_glossy") << name;
}

/// Means of each plane over pictures, and their standard errors.
std::map<std::string, std::pair<double, double>> estimates(const Picture& picture, int pictures,
                                                           std::uint64_t first_seed) {
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(picture.scene);
  std::map<std::string, std::vector<double>> values;
  EngineSettings engine = picture.engine;
  for (int i = 0; i < pictures; ++i) {
    engine.seed = pictures::wide_seed(first_seed + static_cast<std::uint64_t>(i));
    for (const auto& [name, mean] : means(tracer.trace_light(picture.camera, engine, all_types())))
      values[name].push_back(mean.x + mean.y + mean.z);
  }
  std::map<std::string, std::pair<double, double>> found;
  for (const auto& [name, list] : values) {
    const auto n = static_cast<double>(list.size());
    double mean = 0, squares = 0;
    for (const double v : list)
      mean += v / n;
    for (const double v : list)
      squares += (v - mean) * (v - mean);
    found[name] = {mean, std::sqrt(squares / (n - 1) / n)};
  }
  return found;
}

// A constant sky is met by BSDF samples alone; an image of the same radiance is sampled as well. What
// is diffuse and what glossy must not depend on that.
TEST(LightPlanes, AreTheSameByOneStrategyAndByTwo) {
  Picture one = corner(64);
  one.engine.depth_total = 3;
  Picture two = one;
  one.scene.lights = {pictures::constant_light({1, 1, 1})};
  Image ones;
  ones.width = 8;
  ones.height = 4;
  ones.rgb.assign(8 * 4 * 3, 1.0f);
  two.scene.images = {ones};
  two.scene.lights = {pictures::image_light(0)};
  const auto a = estimates(one, 24, 1), b = estimates(two, 24, 1000);
  for (const auto& [name, first] : a) {
    const auto& second = b.at(name);
    EXPECT_NEAR(first.first, second.first, 4.5 * std::hypot(first.second, second.second) + 1e-12)
        << name;
    const bool lit = name.ends_with("diffuse") || name.ends_with("glossy");
    EXPECT_EQ(first.first > 0, lit) << name;
    EXPECT_LE(first.second + second.second, 0.02 * first.first) << name;
  }
}

// A coat's base and the coat itself under a sky of 1: integrals of the BSDF's two parts.
TEST(LightPlanes, OfACoatedFloorAreTheLobesOfItsBsdf) {
  Picture picture = corner(256);
  picture.scene.objects.pop_back();
  picture.scene.lights = {pictures::constant_light({1, 1, 1})};
  const std::vector<materials::Case> cases = materials::all();
  const auto glossy2 = std::find_if(
      cases.begin(), cases.end(), [](const materials::Case& one) { return one.name == "glossy2"; });
  const std::vector<TextureRef>& inputs = picture.scene.materials[0].inputs;
  std::vector<float> p;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (int axis = 0; axis < glossy2->type->inputs[i].width; ++axis)
      p.push_back(inputs[i].constant[axis]);
  p.insert(p.end(), picture.scene.materials[0].numbers.begin(),
           picture.scene.materials[0].numbers.end());
  const Vec3d eye = normalized(picture.camera.position);
  const kernels::Viewer viewer = materials::viewer(eye.z, true, std::atan2(eye.y, eye.x));
  double diffuse = 0, all = 0;
  constexpr int k_steps = 400;
  for (int i = 0; i < k_steps; ++i)
    for (int j = 0; j < k_steps; ++j) {
      const double z = (i + 0.5) / k_steps, phi = 2 * k_pi * (j + 0.5) / k_steps;
      const double sine = std::sqrt(1 - z * z);
      const kernels::real3 wi =
          kernels::vec(static_cast<float>(sine * std::cos(phi)),
                       static_cast<float>(sine * std::sin(phi)), static_cast<float>(z));
      const double cell = 2 * k_pi / (double{k_steps} * k_steps);
      diffuse += cell * double{glossy2->diffuse(p.data(), viewer, wi).y};
      all += cell * double{glossy2->evaluate(p.data(), viewer, wi).value.y};
    }
  const std::map<std::string, Vec3d> found = means(trace_light(picture, all_types()));
  EXPECT_NEAR(found.at("direct_diffuse").y, diffuse, 0.01 * diffuse);
  EXPECT_NEAR(found.at("direct_glossy").y, all - diffuse, 0.01 * (all - diffuse));
  EXPECT_GT(all - diffuse, 0.1);
}

}  // namespace
}  // namespace ds

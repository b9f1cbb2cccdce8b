// SPDX-License-Identifier: Apache-2.0
// Every texture: ranges, known values, and the stack machine that runs graphs of them.
#include "tracer/kernels/lists.h"

// The scene's own list of textures that a program is made with; here all of them, numbered as their
// rows.
#define DS_ROW(sdl_name, prefix, PREFIX) row_##prefix,
enum { DS_ALL_TEXTURES(DS_ROW) row_count };
#define DS_ROW_CASE(sdl_name, prefix, PREFIX) \
  DS_TEXTURE_CASE(prefix, static_cast<int>(row_##prefix))
#define DS_TEXTURES(X) DS_ALL_TEXTURES(DS_ROW_CASE)
#define DS_TEXTURE_STACK 32
#include "tests/render/pictures.h"
#include "tests/tracer/kernels/chi_square.h"
#include "tracer/base/error.h"
#include "tracer/device/texture_code.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/texture_bounds.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

namespace ds {
namespace {

using namespace kernels;

TexturePoint at(float x, float y, float z) {
  TexturePoint point{};
  point.position = vec(x, y, z);
  return point;
}

/// The origin, of the second row of colours below.
SurfacePoint origin() {
  return {vec(0, 0, 0), 0, 0, 0.25f, 0.625f, 1};
}

/// A row of white, and one of r g b a at three corners.
const std::vector<float> k_colors = {1,    1, 1,     1, 1, 1,    1,     1,    1, 1,     1,     1,
                                     0.5f, 0, 0.25f, 1, 1, 0.5f, 0.25f, 0.5f, 0, 0.25f, 0.75f, 0};

/// The first input of material 0 at a point, by its texture program.
real3 run(const Scene& scene, SurfacePoint where) {
  const TextureCode code = texture_code(scene, scene.materials[0]);
  // The rows of colours do not stand first: their offset is asked for.
  std::vector<float> words, tables{-7};
  tables.insert(tables.end(), k_colors.begin(), k_colors.end());
  std::vector<std::uint32_t> offsets;
  for (const Image& image : scene.images) {
    offsets.push_back(static_cast<std::uint32_t>(tables.size()));
    tables.insert(tables.end(), image.rgb.begin(), image.rgb.end());
  }
  std::vector<std::uint32_t> raw = code.words;
  for (const std::size_t i : code.image_words)
    raw[i] = offsets[raw[i]];
  for (const std::size_t i : code.color_words)
    raw[i] = 1;
  for (const std::uint32_t word : raw)
    words.push_back(std::bit_cast<float>(word));
  float inputs[64] = {-1, -1, -1, -1};
  run_texture_program(words.data(), tables.data(), where, true, inputs);
  EXPECT_EQ(inputs[3], -1);  // nothing but the input is written
  return vec(inputs[0], inputs[1], inputs[2]);
}

/// A matte material whose kd is a graph; `add(scene)` makes its textures and returns the last one's
/// index.
template <typename Add>
real3 value_of(const Add& add, SurfacePoint where = origin()) {
  Scene scene;
  pictures::add_material(scene, "matte");
  scene.materials[0].inputs[0] = {{}, add(scene)};
  return run(scene, where);
}

/// A texture whose inputs are constants.
int constant_texture(Scene& scene, std::string_view type, const std::vector<Vec3>& inputs) {
  const int index = pictures::add_texture(scene, type, {});
  for (std::size_t i = 0; i < inputs.size(); ++i)
    scene.textures.back().inputs[i] = {inputs[i], -1};
  return index;
}

void expect_color(real3 got, Vec3 want) {
  EXPECT_FLOAT_EQ(got.x, want.x);
  EXPECT_FLOAT_EQ(got.y, want.y);
  EXPECT_FLOAT_EQ(got.z, want.z);
}

TEST(TextureProgram, Arithmetic) {
  const Vec3 a{0.5f, 2, 3}, b{4, 0.25f, 7};
  expect_color(value_of([&](Scene& s) {
                 return constant_texture(s, "scale", {a, b});
               }),
               {2, 0.5f, 21});
  expect_color(value_of([&](Scene& s) {
                 return constant_texture(s, "add", {a, b});
               }),
               {4.5f, 2.25f, 10});
  expect_color(value_of([&](Scene& s) {
                 return constant_texture(s, "subtract", {a, b});
               }),
               {-3.5f, 1.75f, -4});
  const auto mix = [&](float amount) {
    return value_of([&](Scene& s) {
      return constant_texture(s, "mix", {{amount, amount, amount}, a, b});
    });
  };
  expect_color(mix(0), a);
  expect_color(mix(1), b);
  expect_color(mix(0.5f), {2.25f, 1.125f, 5});
  expect_color(mix(7), b);
  expect_color(mix(-7), a);
}

TEST(TextureProgram, ColorsOfTheMesh) {
  // Corners weigh 1/8, 1/4 and 5/8.
  const Vec3 mixed{0.0625f + 0.25f, 0.125f + 0.15625f, 0.03125f + 0.0625f + 0.46875f};
  const float alpha = 0.125f + 0.125f;
  const auto grey = [&](float channel, SurfacePoint where) {
    return value_of(
        [&](Scene& s) {
          const int index = pictures::add_texture(s, "hitpointgrey", {});
          s.textures.back().numbers = {channel};
          return index;
        },
        where);
  };
  const auto plain = [&](std::string_view type, SurfacePoint where) {
    return value_of([&](Scene& s) { return pictures::add_texture(s, type, {}); }, where);
  };
  expect_color(plain("hitpointcolor", origin()), mixed);
  expect_color(plain("hitpointalpha", origin()), {alpha, alpha, alpha});
  expect_color(grey(0, origin()), {mixed.x, mixed.x, mixed.x});
  expect_color(grey(1, origin()), {mixed.y, mixed.y, mixed.y});
  expect_color(grey(2, origin()), {mixed.z, mixed.z, mixed.z});
  // LuxCore's weights of luminance.
  const float light = 0.212671f * mixed.x + 0.715160f * mixed.y + 0.072169f * mixed.z;
  expect_color(grey(-1, origin()), {light, light, light});
  SurfacePoint white = origin();
  white.colors = 0;
  for (const char* type : {"hitpointcolor", "hitpointgrey", "hitpointalpha"})
    expect_color(plain(type, white), {1, 1, 1});
}

TEST(TextureProgram, Graph) {
  // (a + b) * (a - b) + a, where the same texture stands in two places.
  const Vec3 a{3, 5, 0.5f}, b{1, 2, 4};
  expect_color(value_of([&](Scene& s) {
                 const int sum = constant_texture(s, "add", {a, b});
                 const int difference = constant_texture(s, "subtract", {a, b});
                 const int product = pictures::add_texture(s, "scale", {{}, sum});
                 s.textures.back().inputs[1] = {{}, difference};
                 pictures::add_texture(s, "add", {{}, product});
                 s.textures.back().inputs[1] = {a, -1};
                 return static_cast<int>(s.textures.size()) - 1;
               }),
               {11, 26, -15.25f});
}

TEST(TextureProgram, EveryTextureLeavesOneValue) {
  for (const NodeType& type : texture_types()) {
    Scene scene;
    Image image;
    image.width = 4;  // as long as a row of colours
    image.height = 1;
    image.rgb.assign(k_color_words, 0.25f);
    scene.images.push_back(image);
    pictures::add_material(scene, "glossy2");
    // Two inputs, so that a value left over or missing would shift the second.
    scene.materials[0].inputs[0] = {
        {}, pictures::add_texture(scene, type.name, {{0.3f, 0.3f, 0.3f}, -1})};
    scene.materials[0].inputs[1] = {{}, constant_texture(scene, "add", {{1, 2, 3}, {0, 0, 0}})};
    const TextureCode code = texture_code(scene, scene.materials[0]);
    std::vector<float> words;
    std::vector<std::uint32_t> raw = code.words;
    for (const std::size_t i : code.image_words)
      raw[i] = 0;
    for (const std::uint32_t word : raw)
      words.push_back(std::bit_cast<float>(word));
    float inputs[64] = {};
    run_texture_program(words.data(), image.rgb.data(),
                        {vec(0.1f, 0.2f, 0.3f), 0.4f, 0.6f, 0, 0, 0}, true, inputs);
    EXPECT_TRUE(std::isfinite(inputs[0])) << type.name;
    expect_color(vec(inputs[3], inputs[4], inputs[5]), {1, 2, 3});
    EXPECT_LE(code.stack, 2 + static_cast<int>(type.inputs.size())) << type.name;
    // Where the lane is not meant, nothing is written.
    float untouched[64] = {};
    run_texture_program(words.data(), image.rgb.data(), {vec(0, 0, 0), 0, 0, 0, 0, 0}, false,
                        untouched);
    EXPECT_EQ(untouched[3], 0);
  }
}

TEST(TextureProgram, WhatIsUsedTwiceIsEvaluatedOnce) {
  // 20 additions of the last sum to itself: a million terms, and 21 textures.
  Scene scene;
  pictures::add_material(scene, "matte");
  int last = constant_texture(scene, "add", {{1, 2, 3}, {0, 0, 0}});
  for (int i = 0; i < 20; ++i) {
    const int twice = pictures::add_texture(scene, "add", {{}, last});
    scene.textures.back().inputs[1] = {{}, last};
    last = twice;
  }
  scene.materials[0].inputs[0] = {{}, last};
  const TextureCode code = texture_code(scene, scene.materials[0]);
  EXPECT_EQ(code.op_words.size(), 21u);
  expect_color(run(scene, {vec(0, 0, 0), 0, 0, 0, 0, 0}), {1048576, 2 * 1048576, 3 * 1048576});
}

TEST(TextureProgram, TooDeepAGraphIsAnError) {
  const auto depth = [](int levels) {
    return value_of([&](Scene& s) {
      int last = constant_texture(s, "add", {{1, 1, 1}, {1, 1, 1}});
      for (int i = 0; i < levels; ++i) {
        constant_texture(s, "add", {{1, 1, 1}, {}});
        s.textures.back().inputs[1] = {{}, last};
        last = static_cast<int>(s.textures.size()) - 1;
      }
      return last;
    });
  };
  EXPECT_EQ(depth(k_texture_stack_limit - 2).x, k_texture_stack_limit);
  EXPECT_THROW(depth(k_texture_stack_limit - 1), Error);
}

TEST(Checkerboard, KnownCells) {
  const real3 colours[2] = {vec(1, 1, 1), vec(0, 0, 0)};
  const auto even = [&](float x, float y, float z) {
    return checkerboard3d_evaluate(at(x, y, z), nullptr, colours).x == 1;
  };
  EXPECT_TRUE(even(0.5f, 0.5f, 0.5f));
  EXPECT_FALSE(even(1.5f, 0.5f, 0.5f));
  EXPECT_TRUE(even(1.5f, 1.5f, 0.5f));
  EXPECT_FALSE(even(1.5f, 1.5f, 1.5f));
  EXPECT_FALSE(even(-0.5f, 0.5f, 0.5f));
  EXPECT_TRUE(even(-0.5f, -0.5f, 0.5f));
  EXPECT_FALSE(even(-0.5f, -0.5f, -0.5f));
  EXPECT_TRUE(even(-0.0f, 0, 0));
}

TEST(Checkerboard, KnownCellsOfUvs) {
  const real3 colours[2] = {vec(1, 1, 1), vec(0, 0, 0)};
  const auto even = [&](float u, float v) {
    TexturePoint p = at(9.5f, 3.5f, 0.5f);  // the place does not matter
    p.u = u;
    p.v = v;
    return checkerboard2d_evaluate(p, nullptr, colours).x == 1;
  };
  EXPECT_TRUE(even(0.5f, 0.5f));
  EXPECT_FALSE(even(1.5f, 0.5f));
  EXPECT_FALSE(even(0.5f, 7.5f));
  EXPECT_TRUE(even(1.5f, 1.5f));
  EXPECT_FALSE(even(-0.5f, 0.5f));
  EXPECT_TRUE(even(-0.5f, -2.5f));
}

TEST(Checkerboard, TheMappingOfUvsIsApplied) {
  const auto value = [](float u, float v) {
    return value_of(
               [](Scene& s) {
                 const int index = constant_texture(s, "checkerboard2d", {{1, 1, 1}, {0, 0, 0}});
                 float* const t = s.textures.back().uv_transform;
                 t[0] = 4;  // s = 4 u
                 t[4] = 2;  // t = 2 v + 0.5
                 t[5] = 0.5f;
                 return index;
               },
               {vec(0.3f, 0.4f, 0.5f), u, v, 0, 0, 0})
        .x;
  };
  EXPECT_EQ(value(0.1f, 0.1f), 1);
  EXPECT_EQ(value(0.3f, 0.1f), 0);
  EXPECT_EQ(value(0.1f, 0.3f), 0);
  EXPECT_EQ(value(0.3f, 0.3f), 1);
}

TEST(Checkerboard, TheMappingIsApplied) {
  Scene unused;
  const auto value = [](Vec3 p) {
    return value_of(
               [](Scene& s) {
                 const int index = constant_texture(s, "checkerboard3d", {{1, 1, 1}, {0, 0, 0}});
                 s.textures.back().world_to_texture =
                     Mat4{{10, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
                 return index;
               },
               {vec(p.x, p.y, p.z), 0, 0, 0, 0, 0})
        .x;
  };
  EXPECT_EQ(value({0, 0.5f, 0.5f}), 1);
  EXPECT_EQ(value({0.04f, 0.5f, 0.5f}), 1);
  EXPECT_EQ(value({0.06f, 0.5f, 0.5f}), 0);
  EXPECT_EQ(value({-0.06f, 0.5f, 0.5f}), 0);
}

TEST(Noise, IsBoundedAndHasMeanZeroAndNoJumps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(-1000, 1000);
  double sum = 0, squares = 0;
  for (int i = 0; i < 200000; ++i) {
    const real3 p = vec(u(random), u(random), u(random));
    const float n = gradient_noise(p);
    ASSERT_LE(std::fabs(n), 1.2248f);  // in a cell's middle with all gradients towards it
    sum += double{n};
    squares += double{n} * double{n};
    ASSERT_LT(std::fabs(gradient_noise(vec(p.x + 1e-4f, p.y, p.z)) - n), 1e-3f);
  }
  EXPECT_NEAR(sum / 200000, 0, 4e-3);
  EXPECT_GT(squares / 200000, 0.03);
  for (const float x : {-3.0f, 0.0f, 5.0f})
    EXPECT_EQ(gradient_noise(vec(x, 2, -7)), 0);
}

TEST(Noise, GradientsAreEquallyFrequentAndNeighboursIndependent) {
  // 8 gradients; 64 pairs of a lattice point's and a neighbour's, in seven directions.
  constexpr std::uint32_t k_side = 64;
  const auto gradient = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return noise_signs(x * k_noise_x + y * k_noise_y + z * k_noise_z) >> 29;
  };
  std::vector<double> single(8);
  std::vector<std::vector<double>> pairs(7, std::vector<double>(64));
  for (std::uint32_t i = 0; i < k_side * k_side * k_side; ++i) {
    // Around the origin, where textures are.
    const std::uint32_t x = i % k_side - k_side / 2, y = i / k_side % k_side - k_side / 2,
                        z = i / k_side / k_side - k_side / 2;
    const std::uint32_t own = gradient(x, y, z);
    single[own] += 1;
    for (std::uint32_t d = 1; d < 8; ++d)
      pairs[d - 1][own * 8 + gradient(x + (d & 1), y + (d >> 1 & 1), z + (d >> 2))] += 1;
  }
  constexpr double k_points = double{k_side} * k_side * k_side;
  EXPECT_GT(chance_of_counts(single, std::vector<double>(8, k_points / 8)), sidak(8));
  for (const auto& counts : pairs)
    EXPECT_GT(chance_of_counts(counts, std::vector<double>(64, k_points / 64)), sidak(8));
}

TEST(Noise, HasNoPeriodOf256) {
  int same = 0;
  for (int i = 0; i < 1000; ++i) {
    const float x = 0.37f + 0.71f * static_cast<float>(i);
    if (gradient_noise(vec(x, 0.4f, 0.6f)) == gradient_noise(vec(x + 256, 0.4f, 0.6f))) ++same;
  }
  EXPECT_LT(same, 20);
}

TEST(MarbleAndFbm, AreFiniteForLargeCoordinates) {
  const float marble[] = {8, 0.5f, 1, 0.2f};
  const float fbm[] = {8, 0.5f};
  std::mt19937 random(2);
  for (const float size : {1.0f, 1e3f, 1e6f, 1e7f}) {
    std::uniform_real_distribution<float> u(-size, size);
    for (int i = 0; i < 3000; ++i) {
      const TexturePoint p = at(u(random), u(random), i % 10 == 0 ? 0 : u(random));
      ASSERT_LE(std::fabs(fbm_evaluate(p, fbm, nullptr).x), 2) << size;
      const real3 stone = marble_evaluate(p, marble, nullptr);
      for (const float c : {stone.x, stone.y, stone.z})
        ASSERT_TRUE(c >= 0 && c <= 1) << size;
    }
  }
}

TEST(Marble, TheTurningPointsOfTheSineAreInsideItsColours) {
  // LuxCore reads beyond its table of colours where the sine is 1.
  for (int i = 0; i <= 1000; ++i) {
    const real3 c = marble_colour(static_cast<float>(i) / 1000);
    ASSERT_TRUE(c.x > 0 && c.x < 1 && c.z > 0 && c.z < 1);
  }
  const float numbers[] = {1, 0.5f, 1, 0};  // no noise: the sine of y alone
  for (const double y : {std::acos(0.0), 5 * std::acos(0.0), -std::acos(0.0)})
    ASSERT_TRUE(
        std::isfinite(marble_evaluate(at(0, static_cast<float>(y), 0), numbers, nullptr).x));
}

TEST(Fbm, IsNoiseForOneOctave) {
  const float numbers[] = {1, 0.5f};
  const real3 p = vec(1.3f, -2.4f, 0.8f);
  EXPECT_EQ(fbm_evaluate(at(p.x, p.y, p.z), numbers, nullptr).x, gradient_noise(p));
}

TEST(Wrinkled, IsTheSumOfTheSizesOfItsOctaves) {
  const float one[] = {1, 0.5f}, three[] = {3, 0.25f};
  bool below = false;
  for (int i = 0; i < 200; ++i) {
    const real3 p = vec(1.3f + 0.37f * static_cast<float>(i), -2.4f, 0.8f);
    const TexturePoint point = at(p.x, p.y, p.z);
    below = below || gradient_noise(p) < 0;
    EXPECT_EQ(wrinkled_evaluate(point, one, nullptr).x, std::fabs(gradient_noise(p)));
    const real3 twice = scale(p, 1.99f), thrice = scale(twice, 1.99f);
    EXPECT_NEAR(wrinkled_evaluate(point, three, nullptr).x,
                std::fabs(gradient_noise(p)) + 0.25f * std::fabs(gradient_noise(twice)) +
                    0.0625f * std::fabs(gradient_noise(thrice)),
                1e-6);
  }
  EXPECT_TRUE(below);
}

/// A 3 x 2 image of red values 0 .. 5, top row first.
float texel(ImageWrap wrap, ImageFilter filter, float u, float v) {
  return value_of(
             [&](Scene& s) {
               Image image;
               image.width = 3;
               image.height = 2;
               image.wrap = wrap;
               image.filter = filter;
               for (int i = 0; i < 6; ++i)
                 image.rgb.insert(image.rgb.end(), {static_cast<float>(i), 0.5f, 0.5f});
               s.images.push_back(image);
               return pictures::add_texture(s, "imagemap", {});
             },
             {vec(0, 0, 0), u, v, 0, 0, 0})
      .x;
}

/// Anything in the range, its ends included; 1e6 for what has none.
float drawn(const Parameter& told, std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  const double low = std::max(told.range.least, -1e6), high = std::min(told.range.most, 1e6);
  const double choice = u(random), share = u(random);
  double value = low + (high - low) * share;
  if (choice < 0.15) value = low;
  if (choice > 0.85) value = high;
  if (high - low > 100 && choice > 0.4 && choice < 0.8)
    value = std::clamp(10 * share - 5, low, high);
  return static_cast<float>(told.kind == ParameterKind::whole ? std::round(value) : value);
}

ValueBounds told_bounds(const NodeType& type, const Texture& texture,
                        const std::vector<MaybeBounds>& inputs, const Image& image) {
  if (texture.image >= 0) return bounds_of_pixels(image);
  if (type.host.bounds != nullptr)
    if (const MaybeBounds told = type.host.bounds(inputs, texture.numbers.data())) return *told;
  ADD_FAILURE() << type.name << " tells no bounds of its values";
  return {};
}

// From the rows of each header: nothing is NaN, and no value is beyond the bounds that it tells, which
// are those that warnings of unphysical materials are made of.
TEST(Textures, StayWithinTheirBoundsForAnyInput) {
  std::mt19937 random(9);
  Image image;
  image.width = image.height = 3;
  for (int i = 0; i < 27; ++i)
    image.rgb.push_back(static_cast<float>(i) * 0.05f);
  for (const NodeType& type : texture_types()) {
    for (int trial = 0; trial < 200; ++trial) {
      Scene scene;
      scene.images.push_back(image);
      pictures::add_material(scene, "matte");
      scene.materials[0].inputs[0] = {{}, pictures::add_texture(scene, type.name, {})};
      Texture& texture = scene.textures.back();
      std::vector<MaybeBounds> inputs;
      float size = 1;
      for (std::size_t i = 0; i < texture.inputs.size(); ++i) {
        const Parameter& told = type.inputs[i].told;
        const float x = drawn(told, random), y = drawn(told, random), z = drawn(told, random);
        const Vec3 value = type.inputs[i].width == 1 ? Vec3{x, x, x} : Vec3{x, y, z};
        texture.inputs[i] = {value, -1};
        inputs.push_back(ValueBounds{value, value});
        size = std::max({size, std::fabs(x), std::fabs(y), std::fabs(z)});
      }
      for (std::size_t i = 0; i < texture.numbers.size(); ++i)
        texture.numbers[i] = drawn(type.numbers[i].told, random);
      const ValueBounds bounds = told_bounds(type, texture, inputs, image);
      for (int i = 0; i < 60; ++i) {
        const float far = std::pow(10.0f, static_cast<float>(i % 8));
        std::uniform_real_distribution<float> u(-far, far), share(0, 1);
        SurfacePoint where = origin();
        where.position = vec(u(random), u(random), i % 10 == 0 ? 0 : u(random));
        where.u = u(random);
        where.v = u(random);
        where.b1 = share(random);
        where.b2 = (1 - where.b1) * share(random);
        const real3 got = run(scene, where);
        const std::array values{got.x, got.y, got.z};
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_TRUE(std::isfinite(values[c])) << type.name;
          const float low = bounds.low[static_cast<int>(c)];
          const float high = bounds.high[static_cast<int>(c)];
          const float rounded = 1e-5f * std::max({size, std::fabs(low), std::fabs(high)});
          ASSERT_GE(values[c], low - rounded) << type.name;
          ASSERT_LE(values[c], high + rounded) << type.name;
        }
      }
    }
  }
}

// What the host takes from a header's traits is what its function reads.
TEST(Textures, ReadWhatTheirTraitsSay) {
  Image image;
  image.width = image.height = 2;
  image.rgb = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (const NodeType& type : texture_types()) {
    const auto value = [&](SurfacePoint where) {
      return value_of(
          [&](Scene& scene) {
            scene.images.push_back(image);
            const int index = pictures::add_texture(scene, type.name, {});
            float other = 1;
            for (TextureRef& input : scene.textures.back().inputs) {
              input = {{other, other, other}, -1};
              other *= 0.5f;
            }
            return index;
          },
          where);
    };
    const auto changes = [&](const SurfacePoint& other, const SurfacePoint& from) {
      const real3 a = value(from), b = value(other);
      return a.x != b.x || a.y != b.y || a.z != b.z;
    };
    const SurfacePoint from{vec(0.3f, 0.2f, 0.4f), 0.1f, 0.2f, 0.25f, 0.625f, 1};
    SurfacePoint other = from;
    bool by_position = false;
    for (int i = 1; i < 50; ++i) {
      other.position.x = from.position.x + 0.37f * static_cast<float>(i);
      by_position = by_position || changes(other, from);
    }
    EXPECT_EQ(by_position, has_trait(type, k_trait_position)) << type.name;
    other = from;
    bool by_uv = false;
    for (int i = 1; i < 50; ++i) {
      other.u = from.u + 0.37f * static_cast<float>(i);
      by_uv = by_uv || changes(other, from);
    }
    EXPECT_EQ(by_uv, has_trait(type, k_trait_uv)) << type.name;
    other = from;
    other.colors = 0;
    EXPECT_EQ(changes(other, from), has_trait(type, k_trait_colors)) << type.name;
  }
}

TEST(Imagemap, TexelsStandWhereTheSceneSays) {
  // scene.h: (0, 0) is the top left corner; texel (i, j) has its centre at ((i + 0.5) / width, (j +
  // 0.5) / height).
  for (const ImageFilter filter : {ImageFilter::nearest, ImageFilter::linear})
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(texel(ImageWrap::repeat, filter, (static_cast<float>(i % 3) + 0.5f) / 3,
                        (static_cast<float>(i / 3) + 0.5f) / 2),
                  i, 1e-5);
}

TEST(Imagemap, LinearIsBetweenTexels) {
  EXPECT_NEAR(texel(ImageWrap::clamp, ImageFilter::linear, 1.0f / 3, 0.25f), 0.5, 1e-5);
  EXPECT_NEAR(texel(ImageWrap::clamp, ImageFilter::linear, 0.5f, 0.5f), 2.5, 1e-5);
  EXPECT_NEAR(texel(ImageWrap::repeat, ImageFilter::linear, 0, 0.25f), 1,
              1e-5);  // half of texels 2 and 0
}

TEST(Imagemap, WrapModes) {
  const ImageFilter nearest = ImageFilter::nearest;
  EXPECT_EQ(texel(ImageWrap::repeat, nearest, 1.1f, 0.1f), 0);
  EXPECT_EQ(texel(ImageWrap::repeat, nearest, -0.1f, 0.1f), 2);
  EXPECT_EQ(texel(ImageWrap::repeat, nearest, 0.1f, -0.1f), 3);
  EXPECT_EQ(texel(ImageWrap::repeat, nearest, 0.1f, 7.1f), 0);
  EXPECT_EQ(texel(ImageWrap::clamp, nearest, 1.1f, 0.1f), 2);
  EXPECT_EQ(texel(ImageWrap::clamp, nearest, -5, 3), 3);
  EXPECT_EQ(texel(ImageWrap::black, nearest, 1.1f, 0.1f), 0);
  EXPECT_EQ(texel(ImageWrap::black, nearest, 0.9f, 0.9f), 5);
  EXPECT_EQ(texel(ImageWrap::white, nearest, 0.5f, -0.1f), 1);
  EXPECT_EQ(texel(ImageWrap::white, nearest, 0.9f, 0.9f), 5);
}

TEST(Imagemap, LargeCoordinatesStayInside) {
  for (const ImageWrap wrap :
       {ImageWrap::repeat, ImageWrap::clamp, ImageWrap::black, ImageWrap::white})
    for (const ImageFilter filter : {ImageFilter::nearest, ImageFilter::linear})
      for (const float u : {1e6f, -1e6f, 1e8f, -1e8f}) {
        const float value = texel(wrap, filter, u, -u);
        EXPECT_TRUE(value >= 0 && value <= 5);
      }
}

TEST(Imagemap, TheMappingIsApplied) {
  const float value = [] {
    return value_of(
               [](Scene& s) {
                 Image image;
                 image.width = 2;
                 image.height = 1;
                 image.filter = ImageFilter::nearest;
                 image.rgb = {1, 1, 1, 2, 2, 2};
                 s.images.push_back(image);
                 const int index = pictures::add_texture(s, "imagemap", {});
                 const float swapped[6] = {0, 1, 0, 1, 0, 0};  // s = v, t = u
                 std::copy(std::begin(swapped), std::end(swapped),
                           std::begin(s.textures.back().uv_transform));
                 return index;
               },
               {vec(0, 0, 0), 0.1f, 0.9f, 0, 0, 0})
        .x;
  }();
  EXPECT_EQ(value, 2);
}

}  // namespace
}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Every material of kernels/lists.h: what it samples is what its pdf says, no energy is made,
// nothing is ever NaN.
#include "tests/tracer/kernels/chi_square.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/base/vec.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ds {
namespace {

using namespace kernels;
using materials::Case;

constexpr double k_pi = std::numbers::pi;
constexpr std::array k_cosines = {1.0, 0.7, 0.3, 0.05, 0.001};
constexpr std::array k_roughnesses = {1e-3f, 0.1f, 1.0f};

std::string test_name(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name);
}

class Bsdf : public testing::TestWithParam<Case> {
 protected:
  BsdfSample sample(const std::vector<float>& p, Viewer v) {
    return GetParam().sample(p.data(), v, {number(), number()}, {number(), number()});
  }
  BsdfValue evaluate(const std::vector<float>& p, Viewer v, real3 wi) {
    return GetParam().evaluate(p.data(), v, wi);
  }
  float number() { return kernels::unit_interval(static_cast<std::uint32_t>(random_())); }
  std::mt19937 random_{7};

  /// Whether every lobe is a Dirac.
  bool is_specular(const std::vector<float>& p) {
    for (int i = 0; i < 100; ++i)
      if (!sample(p, materials::viewer(0.5)).specular) return false;
    return true;
  }
};

/// Directions around an axis in rings that widen from it, so that a narrow lobe about it fills many
/// cells.
class Rings {
 public:
  static constexpr int k_rings = 26, k_sectors = 12;

  Rings(real3 axis, double narrowest) : frame_(frame_around(axis)), narrowest_(narrowest) {}
  double edge(int ring) const {
    return ring == 0 ? 0.0
                     : narrowest_ * std::pow(k_pi / narrowest_, (ring - 1.0) / (k_rings - 1.0));
  }
  int cell(real3 d) const {
    const real3 l = to_local(frame_, d);
    // From the chord: the arc cosine near 1 has few bits.
    const real3 chord = sub(d, frame_.n);
    const double angle = 2 * std::asin(std::min(1.0, 0.5 * std::sqrt(double{dot(chord, chord)})));
    int ring = 0;
    while (ring + 1 < k_rings && angle >= edge(ring + 1))
      ++ring;
    const double turn = (std::atan2(double{l.y}, double{l.x}) / k_pi + 1) / 2;
    return ring * k_sectors + std::min(static_cast<int>(turn * k_sectors), k_sectors - 1);
  }
  /// The pdf's integral over a cell by a midpoint rule.
  template <typename Pdf>
  double integral(int cell, int steps, const Pdf& pdf) const {
    const double low = edge(cell / k_sectors);
    const double high = edge(cell / k_sectors + 1);
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double angle = low + (high - low) * (i + 0.5) / steps;
        const double azimuth = ((cell % k_sectors + (j + 0.5) / steps) / k_sectors * 2 - 1) * k_pi;
        const double s = std::sin(angle);
        const real3 d = to_world(frame_, vec(static_cast<float>(s * std::cos(azimuth)),
                                             static_cast<float>(s * std::sin(azimuth)),
                                             static_cast<float>(std::cos(angle))));
        sum += pdf(unit(d)) * s;
      }
    return sum * (high - low) / steps * 2 * k_pi / k_sectors / steps;
  }

 private:
  Frame frame_;
  double narrowest_;
};

/// Directions where lobes are, on either side of the surface: the mirrored one, and the refracted one of
/// the default indices or, of total reflection, one in the surface.
std::array<real3, 2> lobe_axes(Viewer v) {
  const float eta = v.outside ? 1.5f : 1 / 1.5f;
  const float z2 = 1 - (1 - v.wo.z * v.wo.z) / (eta * eta);
  const real3 refracted = vec(-v.wo.x / eta, -v.wo.y / eta, -std::sqrt(std::max(z2, 1e-6f)));
  return {vec(-v.wo.x, -v.wo.y, v.wo.z), unit(refracted)};
}

/// Of a material's lobes: disney's coat is narrow whatever the roughness.
double narrowest_alpha(const Case& material, float roughness) {
  return material.name == "disney" ? std::min(0.05, double{roughness}) : double{roughness};
}

TEST_P(Bsdf, SamplesFollowThePdf) {
  if (is_specular(materials::inputs(GetParam(), 0.1f))) GTEST_SKIP() << "only Dirac lobes";
  const int axes = has_trait(*GetParam().type, k_trait_transmits) ? 2 : 1;
  const double limit =
      sidak(static_cast<double>(k_cosines.size() * k_roughnesses.size()) * axes * axes);
  constexpr int k_samples = 200000;
  for (const float roughness : k_roughnesses)
    for (const double cosine : k_cosines)
      for (int way = 0; way < axes * axes; ++way) {
        // Across the plane of incidence the lobe is 2 alpha cosine wide: 2e-6 at the extreme, which
        // no direction of floats resolves.
        if (double{roughness} * cosine < 1e-5) continue;
        const std::vector<float> p = materials::inputs(GetParam(), roughness);
        const Viewer v = materials::viewer(cosine, way < 2);
        const bool below = way % 2 == 1;
        const Rings rings(lobe_axes(v)[below ? 1 : 0],
                          0.1 * narrowest_alpha(GetParam(), roughness));
        std::vector<double> counts(Rings::k_rings * Rings::k_sectors), expected(counts.size());
        for (int i = 0; i < k_samples; ++i) {
          const BsdfSample s = sample(p, v);
          if (!s.valid || s.specular || (s.wi.z < 0) != below) continue;
          ASSERT_GT(evaluate(p, v, s.wi).pdf, 0.0f);
          counts[static_cast<std::size_t>(rings.cell(s.wi))] += 1;
        }
        const auto integrate = [&](int steps) {
          double total = 0;
          for (int cell = 0; cell < static_cast<int>(expected.size()); ++cell) {
            const double e = rings.integral(cell, steps, [&](real3 wi) {
              return (wi.z < 0) == below ? double{evaluate(p, v, wi).pdf} : 0.0;
            });
            total += e;
            expected[static_cast<std::size_t>(cell)] = e * k_samples;
          }
          return total;
        };
        double total = integrate(40);
        const std::string where =
            fmt::format("roughness {}, cosine {}, {}, {}", roughness, cosine,
                        v.outside ? "outside" : "inside", below ? "through" : "back");
        EXPECT_LE(total, 1.01) << where;
        if (total > 0.01) {
          EXPECT_GT(chance_of_counts(counts, expected), limit)
              << where << ", pdf's integral " << total;
        } else {
          // Too few for the cells, and peaked: beyond the rim of total reflection.
          total = integrate(200);
          const double seen = std::accumulate(counts.begin(), counts.end(), 0.0) / k_samples;
          EXPECT_NEAR(seen, total, 5 * std::sqrt(total / k_samples) + 1e-4) << where;
        }
      }
}

TEST_P(Bsdf, WeightIsValueOverPdf) {
  if (GetParam().name == "mix") GTEST_SKIP() << "a sample is weighed by the part it chose";
  for (const float roughness : k_roughnesses)
    for (const double cosine : k_cosines) {
      const std::vector<float> p = materials::inputs(GetParam(), roughness);
      const Viewer v = materials::viewer(cosine);
      for (int i = 0; i < 2000; ++i) {
        const BsdfSample s = sample(p, v);
        if (!s.valid) continue;
        const BsdfValue at = evaluate(p, v, s.wi);
        if (s.specular) {
          EXPECT_EQ(at.pdf, 0.0f);
          EXPECT_EQ(at.value.x, 0.0f);
          continue;
        }
        // The half vector made from the rounded direction is off by 1e-7 over its length, about
        // twice the cosine; a lobe of width alpha sees that as 1e-7 / (2 alpha cosine).
        const double tolerance = 1e-4 + 3e-7 / (double{roughness} * cosine);
        EXPECT_NEAR(double{at.pdf / s.pdf}, 1.0, tolerance);
        EXPECT_NEAR(double{s.weight.x * s.pdf}, double{at.value.x}, tolerance * double{at.value.x});
        EXPECT_NEAR(std::sqrt(double{dot(s.wi, s.wi)}), 1.0, 1e-5);
      }
    }
}

TEST_P(Bsdf, MakesNoEnergy) {
  for (const float roughness : {0.0f, 1e-4f, 0.1f, 1.0f})
    for (const double degrees : {0.0, 45.0, 80.0, 89.9})
      for (const bool outside : {true, false}) {
        const std::vector<float> p = materials::white_inputs(GetParam(), roughness);
        const Viewer v = materials::viewer(std::cos(degrees * k_pi / 180), outside);
        constexpr int k_samples = 40000;
        double sum = 0, squares = 0;
        for (int i = 0; i < k_samples; ++i) {
          const BsdfSample s = sample(p, v);
          // Radiance over the square of the index is what is kept (Veach 1997, 5.2).
          const double w = s.valid ? double{s.weight.x / s.eta_scale} : 0.0;
          sum += w;
          squares += w * w;
        }
        const double mean = sum / k_samples;
        const double error =
            std::sqrt(std::max(0.0, squares / k_samples - mean * mean) / k_samples);
        EXPECT_LE(mean, 1 + 3 * error + 1e-5)
            << "roughness " << roughness << ", " << degrees << " degrees";
        EXPECT_GT(mean, 0.05) << "roughness " << roughness << ", " << degrees << " degrees";
      }
}

TEST_P(Bsdf, IsReciprocal) {
  bool above = false, below = false;
  for (int trial = 0; trial < 5000; ++trial) {
    const std::vector<float> p = materials::inputs(GetParam(), trial % 2 == 0 ? 0.1f : 0.6f);
    const Viewer a = materials::viewer(0.02 + 0.98 * double{number()});
    const float side = trial % 4 < 2 ? 1.0f : -1.0f;
    const real3 wi = unit(vec(number() - 0.5f, number() - 0.5f, side * (0.01f + number())));
    // Seen from the other side the frame is turned over about its x axis.
    Viewer b = a;
    b.wo = vec(wi.x, side * wi.y, side * wi.z);
    b.outside = side > 0 ? a.outside : !a.outside;
    const real3 back_wi = vec(a.wo.x, side * a.wo.y, side * a.wo.z);
    // What is kept on the way through is radiance over the square of the index (Veach 1997, 5.2).
    const double scale = side > 0 ? 1.0 : 1.5 * 1.5;
    const double there = scale * double{evaluate(p, a, wi).value.y} / double{b.wo.z};
    const double back = double{evaluate(p, b, back_wi).value.y} / double{a.wo.z};
    EXPECT_NEAR(there, back, 1e-4 * (there + back) + 1e-7);
    (side > 0 ? above : below) = (side > 0 ? above : below) || there > 0;
  }
  EXPECT_EQ(above, !is_specular(materials::inputs(GetParam(), 0.1f)));
  EXPECT_EQ(below, has_trait(*GetParam().type, k_trait_transmits));
}

// A Dirac lobe has no value to compare: the way back is sampled instead. It leads to where the way
// there came from, with the same share of light but for the change of radiance in refraction, which
// it undoes.
TEST_P(Bsdf, DiracLobesLeadBack) {
  int refracted = 0, seen = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::vector<float> p = materials::inputs(GetParam(), 0.1f);
    const Viewer a = materials::viewer(0.1 + 0.9 * double{number()}, number() < 0.5f);
    const real2 u = {number(), number()}, lobe = {number() < 0.5f ? 0.0f : 0.9999f, number()};
    const BsdfSample there = GetParam().sample(p.data(), a, u, lobe);
    if (!there.valid || !there.specular) continue;
    ++seen;
    const float side = there.wi.z < 0 ? -1.0f : 1.0f;  // of the frame on the other side
    if (std::fabs(there.wi.z) < 0.05f) continue;
    refracted += side < 0 ? 1 : 0;
    Viewer b = a;
    b.wo = vec(there.wi.x, there.wi.y, side * there.wi.z);
    b.outside = side < 0 ? !a.outside : a.outside;
    const BsdfSample back = GetParam().sample(p.data(), b, u, lobe);
    ASSERT_TRUE(back.valid && back.specular);
    EXPECT_NEAR(back.wi.x, a.wo.x, 1e-5);
    EXPECT_NEAR(back.wi.y, a.wo.y, 1e-5);
    EXPECT_NEAR(side * back.wi.z, a.wo.z, 1e-5);
    EXPECT_NEAR(there.eta_scale * back.eta_scale, 1, 1e-5);
    EXPECT_NEAR(there.weight.y / there.eta_scale, back.weight.y / back.eta_scale, 1e-5);
  }
  const bool is_glass = GetParam().name == "glass";
  EXPECT_EQ(seen > 0, is_glass || GetParam().name == "mirror" || GetParam().name == "mix");
  EXPECT_EQ(refracted > 0, is_glass);
}

// What the host takes from a header's traits is what its functions do.
TEST_P(Bsdf, ChoosesByANumberWhereItHasLobes) {
  bool depends = false;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<float> p =
        materials::random_inputs(GetParam(), random_, materials::Shares::physical);
    const Viewer v = materials::viewer(0.01 + 0.98 * double{number()}, number() < 0.5f);
    const real2 u = {number(), number()};
    const BsdfSample a = GetParam().sample(p.data(), v, u, {number(), number()});
    const BsdfSample b = GetParam().sample(p.data(), v, u, {number(), number()});
    depends = depends || a.wi.x != b.wi.x || a.wi.z != b.wi.z || a.glossy != b.glossy;
  }
  EXPECT_EQ(depends, has_trait(*GetParam().type, k_trait_lobes));
}

TEST_P(Bsdf, CastsAndReceivesCausticsByItsLobes) {
  if (GetParam().type->children > 0) return;  // its parts do
  bool gathers = false, spreads = false;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<float> p =
        materials::random_inputs(GetParam(), random_, materials::Shares::physical);
    const BsdfSample s =
        sample(p, materials::viewer(0.01 + 0.98 * double{number()}, number() < 0.5f));
    if (!s.valid) continue;
    (s.specular || s.glossy ? gathers : spreads) = true;
  }
  EXPECT_EQ(gathers, has_trait(*GetParam().type, k_trait_casts_caustics));
  // metal2's light after several reflections among its facets is spread, but is little.
  if (GetParam().name != "metal2") {
    EXPECT_EQ(spreads, has_trait(*GetParam().type, k_trait_receives_caustics));
  }
}

TEST_P(Bsdf, DiffusePartIsAPartOfTheValue) {
  bool some = false, all = true;
  for (int trial = 0; trial < 5000; ++trial) {
    const std::vector<float> p =
        materials::random_inputs(GetParam(), random_, materials::Shares::physical);
    const Viewer v = materials::viewer(0.01 + 0.98 * double{number()}, trial % 2 == 0);
    const real3 wi = unit(vec(number() - 0.5f, number() - 0.5f, number() - 0.3f));
    const real3 whole = evaluate(p, v, wi).value;
    const real3 part = GetParam().diffuse(p.data(), v, wi);
    for (const auto& [of, all_of] :
         {std::pair{part.x, whole.x}, {part.y, whole.y}, {part.z, whole.z}}) {
      ASSERT_GE(of, 0.0f);
      ASSERT_LE(of, all_of * 1.000001f) << testing::PrintToString(p);
      some = some || of > 0;
      all = all && of == all_of;
    }
  }
  const NodeType& type = *GetParam().type;
  const bool chooses = type.children > 0;
  // metal2's light after several reflections counts as glossy.
  EXPECT_EQ(some, chooses || (has_trait(type, k_trait_receives_caustics) && type.name != "metal2"));
  EXPECT_EQ(all, (!chooses && !has_trait(type, k_trait_casts_caustics)) ||
                     is_specular(materials::inputs(GetParam(), 0.1f)));
}

INSTANTIATE_TEST_SUITE_P(Every, Bsdf, testing::ValuesIn(materials::all()), test_name);

// As LuxCore has it: the back of glossy2 is its base alone, unless it is double-sided.
TEST(Glossy2, HasNoCoatOnItsBackUnlessItIsDoublesided) {
  const std::vector<Case> cases = materials::all();
  const Case& glossy2 =
      *std::find_if(cases.begin(), cases.end(), [](const Case& c) { return c.name == "glossy2"; });
  std::vector<float> p = materials::inputs(glossy2, 0.2f);
  p[glossy2_kd] = 0.25f;
  p[glossy2_d] = 2;  // nor does it absorb
  p[glossy2_ka] = 3;
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    const auto number = [&] { return unit_interval(static_cast<std::uint32_t>(random())); };
    const float azimuth = 6 * number();
    Viewer back = materials::viewer(0.01 + 0.98 * double{number()}, false, double{azimuth});
    Viewer front = back;
    front.outside = true;
    const real2 u = {number(), number()}, lobe = {number(), number()};
    p[glossy2_doublesided] = 0;
    const BsdfSample s = glossy2.sample(p.data(), back, u, lobe);
    ASSERT_TRUE(s.valid && !s.glossy && !s.specular);
    const BsdfValue v = glossy2.evaluate(p.data(), back, s.wi);
    EXPECT_NEAR(double{v.value.x}, 0.25 * double{s.wi.z} / k_pi, 1e-6);
    EXPECT_NEAR(double{v.value.y}, 0.5 * double{s.wi.z} / k_pi, 1e-6);
    EXPECT_NEAR(double{v.pdf}, double{s.wi.z} / k_pi, 1e-6);
    EXPECT_NEAR(double{s.weight.x}, 0.25, 1e-5);
    p[glossy2_doublesided] = 1;
    const BsdfValue a = glossy2.evaluate(p.data(), back, s.wi);
    const BsdfValue b = glossy2.evaluate(p.data(), front, s.wi);
    EXPECT_EQ(a.value.x, b.value.x);
    EXPECT_EQ(a.pdf, b.pdf);
  }
}

// LuxCore's velvet is kd / (4 pi) P thickness / cos_o, times the cosine of wi in it, P as in the
// header, negative numbers cut off.
TEST(Velvet, IsLuxCoresWhereItReturnsNoMoreThanCame) {
  const std::vector<Case> cases = materials::all();
  const Case& velvet =
      *std::find_if(cases.begin(), cases.end(), [](const Case& c) { return c.name == "velvet"; });
  std::vector<float> p = materials::inputs(velvet, 0);
  std::mt19937 random(5);
  const auto number = [&] { return unit_interval(static_cast<std::uint32_t>(random())); };
  const auto phase = [&](double c) {
    const double p1 = double{p[velvet_p1]}, p2 = double{p[velvet_p2]}, p3 = double{p[velvet_p3]};
    return std::max(0.0, 1 + p1 * c + p2 * (3 * c * c - 1) / 2 + p3 * (5 * c * c * c - 3 * c) / 2);
  };
  int equal = 0, less = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    if (trial % 8 == 4) {
      p[velvet_p1] = 4 * number() - 2;
      p[velvet_p2] = 30 * number() - 5;
      p[velvet_p3] = 4 * number() - 2;
      p[velvet_thickness] = 0.2f * number();
    }
    double mean = 0;
    for (int i = 0; i < 2000; ++i)
      mean += phase((i + 0.5) / 1000 - 1) / 2000;
    const double thick = double{p[velvet_thickness]} * mean;
    const Viewer v = materials::viewer(0.01 + 0.99 * double{number()});
    const float x = number() - 0.5f, y = number() - 0.5f;  // in the order of every compiler
    const real3 wi = unit(vec(x, y, 0.01f + number()));
    const double lower = std::min(double{v.wo.z}, double{wi.z});
    const double luxcore = 0.5 / (4 * k_pi) * phase(-double{dot(v.wo, wi)}) *
                           double{p[velvet_thickness]} / double{v.wo.z};
    const double found = double{velvet.evaluate(p.data(), v, wi).value.x};
    // The mean is of 32 nodes here, and so are what depends on it.
    if (lower > 1.02 * thick) {
      EXPECT_NEAR(found, luxcore, 2e-6 / double{v.wo.z});
      equal += luxcore > 0 ? 1 : 0;
    } else if (lower < 0.98 * thick) {
      EXPECT_NEAR(found, luxcore * lower / thick, 0.02 * luxcore + 2e-6);
      less += luxcore > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(equal, 400);
  EXPECT_GT(less, 400);
}

TEST(Fresnel, Dielectric) {
  float cos_t = 0;
  EXPECT_NEAR(dielectric_fresnel(1.5f, 1, &cos_t), 0.04, 1e-6);
  EXPECT_NEAR(dielectric_fresnel(1.5f, 0, &cos_t), 1, 1e-6);
  EXPECT_NEAR(dielectric_fresnel(1, 0.3f, &cos_t), 0, 1e-12);  // no boundary
  // Snell: sin 60 / 1.5.
  dielectric_fresnel(1.5f, 0.5f, &cos_t);
  EXPECT_NEAR(double{cos_t}, std::sqrt(1 - 0.75 / 2.25), 1e-6);
  // Total reflection beyond asin(1 / 1.5) = 41.8 degrees.
  EXPECT_EQ(dielectric_fresnel(1 / 1.5f, static_cast<float>(std::cos(42 * k_pi / 180)), &cos_t), 1);
  EXPECT_EQ(cos_t, 0);
  EXPECT_LT(dielectric_fresnel(1 / 1.5f, static_cast<float>(std::cos(41 * k_pi / 180)), &cos_t),
            0.7f);
  // Brewster's angle: only one polarisation is left.
  const double brewster = std::atan(1.5);
  const double rs = (std::cos(brewster) - 1.5 * std::sin(brewster)) /
                    (std::cos(brewster) + 1.5 * std::sin(brewster));
  EXPECT_NEAR(dielectric_fresnel(1.5f, static_cast<float>(std::cos(brewster)), &cos_t), rs * rs / 2,
              1e-6);
}

TEST(Fresnel, ConductorWithoutAbsorptionIsADielectric) {
  for (double cosine = 0; cosine <= 1; cosine += 0.01) {
    float cos_t = 0;
    const auto c = static_cast<float>(cosine);
    EXPECT_NEAR(conductor_fresnel(1.5f, 0, c), dielectric_fresnel(1.5f, c, &cos_t), 2e-6) << cosine;
  }
}

TEST(Fresnel, ConductorAtNormalIncidence) {
  // ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
  for (const auto& [n, k] :
       {std::pair{0.2f, 3.9f}, std::pair{1.37f, 7.6f}, std::pair{0.0f, 3.0f}}) {
    const double expected =
        ((n - 1.0) * (n - 1.0) + double{k * k}) / ((n + 1.0) * (n + 1.0) + double{k * k});
    EXPECT_NEAR(conductor_fresnel(n, k, 1), expected, 1e-5);
    EXPECT_NEAR(conductor_fresnel(n, k, 0), 1, 1e-6);
  }
}

TEST(Glass, TheRadianceScalesOfBothSidesCancel) {
  const std::vector<Case> all = materials::all();
  const Case glass =
      *std::find_if(all.begin(), all.end(), [](const Case& c) { return c.name == "glass"; });
  const std::vector<float> p = materials::inputs(glass, 0);
  const Viewer out = materials::viewer(0.8, true);
  const BsdfSample in = glass.sample(p.data(), out, {0.5f, 0.5f}, {0.9f, 0});
  ASSERT_LT(in.wi.z, 0);
  EXPECT_NEAR(in.eta_scale, 1 / 2.25, 1e-6);
  Viewer inside;
  inside.wo = negate(in.wi);
  inside.outside = false;
  const BsdfSample back = glass.sample(p.data(), inside, {0.5f, 0.5f}, {0.9f, 0});
  EXPECT_NEAR(in.eta_scale * back.eta_scale, 1, 1e-6);
}

}  // namespace
}  // namespace ds

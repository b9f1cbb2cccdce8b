// SPDX-License-Identifier: Apache-2.0
// Disney's surface against what is published, written down anew in double, and its closed forms of albedos against
// integrals.
#include "tests/tracer/kernels/materials.h"
#include "tracer/base/vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace ds {
namespace {

using namespace kernels;
using materials::Case;

constexpr double k_pi = std::numbers::pi;

const Case& disney() {
  static const std::vector<Case> cases = materials::all();
  return *std::find_if(cases.begin(), cases.end(),
                       [](const Case& c) { return c.name == "disney"; });
}

/// Of one colour channel: Burley's listings (BRDF Explorer, disney.brdf) with LuxCore's square of the roughness, whole
/// coat and blue of a tint; before anything is scaled, without the cosine.
struct Published {
  double diffuse, subsurface, sheen, facets, coat;
};

double schlick(double cosine) {
  return std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}
double mixed(double a, double b, double t) {
  return a + (b - a) * t;
}

Published published(const std::vector<float>& p, int channel, Vec3d o, Vec3d i) {
  const auto at = [&](int slot) { return double{p[static_cast<std::size_t>(slot)]}; };
  const Vec3d h = normalized(o + i);
  const double lh = dot(i, h), rough = at(disney_roughness), m = at(disney_metallic);
  const double fl = schlick(i.z), fv = schlick(o.z), fh = schlick(lh),
               b = at(disney_basecolor + channel);
  const double fd90 = 0.5 + 2 * lh * lh * rough * rough;
  const double fss90 = lh * lh * rough;
  const double fss = mixed(1, fss90, fl) * mixed(1, fss90, fv);
  const double tint_of =
      0.3 * at(disney_basecolor) + 0.6 * at(disney_basecolor + 1) + at(disney_basecolor + 2);
  const double tint = tint_of > 0 ? b / tint_of : 1;
  const double aspect = std::sqrt(1 - 0.9 * at(disney_anisotropic));
  const double ax = std::clamp(rough * rough / aspect, 1e-3, 1.0);
  const double ay = std::clamp(rough * rough * aspect, 1e-3, 1.0);
  const double spread = std::pow(h.x / ax, 2) + std::pow(h.y / ay, 2) + h.z * h.z;
  const auto smith = [](Vec3d w, double x, double y) {
    return 1 / (w.z + std::sqrt(std::pow(w.x * x, 2) + std::pow(w.y * y, 2) + w.z * w.z));
  };
  const double at_normal =
      mixed(at(disney_specular) * 0.08 * mixed(1, tint, at(disney_speculartint)), b, m);
  const double a = mixed(0.1, 0.001, at(disney_clearcoatgloss)), a2 = a * a;
  Published f{};
  f.diffuse =
      (1 - m) * (1 - at(disney_subsurface)) * b / k_pi * mixed(1, fd90, fl) * mixed(1, fd90, fv);
  f.subsurface =
      (1 - m) * at(disney_subsurface) * b / k_pi * 1.25 * (fss * (1 / (i.z + o.z) - 0.5) + 0.5);
  f.sheen = (1 - m) * at(disney_sheen) * mixed(1, tint, at(disney_sheentint)) * fh;
  f.facets = mixed(at_normal, 1, fh) / (k_pi * ax * ay * spread * spread) * smith(o, ax, ay) *
             smith(i, ax, ay);
  f.coat = at(disney_clearcoat) * mixed(0.04, 1, fh) * (a2 - 1) /
           (k_pi * std::log(a2) * (1 + (a2 - 1) * h.z * h.z)) * smith(o, 0.25, 0.25) *
           smith(i, 0.25, 0.25);
  return f;
}
double sum(const Published& f) {
  return f.diffuse + f.subsurface + f.sheen + f.facets + f.coat;
}

Vec3d to_double(real3 v) {
  return {double{v.x}, double{v.y}, double{v.z}};
}

/// Of a function of the direction over the hemisphere, times the cosine.
double hemisphere(const std::function<double(Vec3d)>& f, int turns) {
  constexpr int k_heights = 400;
  double total = 0;
  for (int k = 0; k < k_heights; ++k) {
    // Finer towards the horizon.
    const double t = (k + 0.5) / k_heights, c = t * t, s = std::sqrt(1 - c * c);
    for (int turn = 0; turn < turns; ++turn) {
      const double a = (turn + 0.5) / turns * 2 * k_pi;
      total += f({s * std::cos(a), s * std::sin(a), c}) * c * 2 * t;
    }
  }
  return total / k_heights * 2 * k_pi / turns;
}

class Disney : public testing::Test {
 protected:
  float number() { return unit_interval(static_cast<std::uint32_t>(random_())); }
  std::mt19937 random_{11};
};

// Dark enough that no part of the hemisphere gives back more than came, it is what is published; else a share of it.
TEST_F(Disney, IsWhatIsPublishedWhereThatReturnsNoMoreThanCame) {
  int same = 0, scaled = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<float> p = materials::random_inputs(disney(), random_);
    const bool dark = trial % 2 == 0;
    if (dark) {
      for (int c = 0; c < 3; ++c)
        p[static_cast<std::size_t>(disney_basecolor + c)] *= 0.3f;
      p[disney_sheen] *= 0.2f;
      p[disney_clearcoat] *= 0.5f;
    }
    // Where floats resolve the lobes.
    p[disney_roughness] = std::max(p[disney_roughness], 0.15f);
    p[disney_clearcoatgloss] = std::min(p[disney_clearcoatgloss], 0.8f);
    const Viewer v =
        materials::viewer((dark ? 0.4 : 0.02) + (dark ? 0.6 : 0.98) * double{number()});
    const real3 wi = unit(vec(number() - 0.5f, number() - 0.5f, (dark ? 0.6f : 0.01f) + number()));
    const real3 found = disney().evaluate(p.data(), v, wi).value;
    const std::array channels{found.x, found.y, found.z};
    std::array<double, 3> all{};
    for (int c = 0; c < 3; ++c)
      all[static_cast<std::size_t>(c)] =
          sum(published(p, c, to_double(v.wo), to_double(wi))) * double{wi.z};
    const auto brightest =
        static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin());
    const double share = dark ? 1 : double{channels[brightest]} / all[brightest];
    EXPECT_LE(share, 1.001);
    same += share > 0.999 ? 1 : 0;
    scaled += share < 0.99 ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(double{channels[c]}, share * all[c], 1e-3 * share * all[c] + 1e-6)
          << testing::PrintToString(p);
  }
  EXPECT_GT(scaled, 1000);
  EXPECT_GT(same, 10000);
}

// Whatever is said: the corners of all ranges are among the inputs.
TEST_F(Disney, SendsOnNoMoreThanComes) {
  for (int trial = 0; trial < 600; ++trial) {
    std::vector<float> p = materials::random_inputs(disney(), random_);
    if (trial % 2 == 0)
      for (int c = 0; c < 3; ++c)
        p[static_cast<std::size_t>(disney_basecolor + c)] = 1;
    const double cosine =
        std::array{1.0, 0.6, 0.2, 0.05, 0.005}[static_cast<std::size_t>(trial % 5)];
    const Viewer v = materials::viewer(cosine, true, double{number()} * 6);
    constexpr int k_samples = 4000;
    double total = 0, squares = 0;
    for (int i = 0; i < k_samples; ++i) {
      const BsdfSample s = disney().sample(p.data(), v, {number(), number()}, {number(), number()});
      const double w = s.valid ? double{max_component(s.weight)} : 0.0;
      total += w;
      squares += w * w;
    }
    const double mean = total / k_samples;
    const double error = std::sqrt(std::max(0.0, squares / k_samples - mean * mean) / k_samples);
    EXPECT_LE(mean, 1 + 4.5 * error + 1e-5)
        << "cosine " << cosine << ", " << testing::PrintToString(p);
  }
}

// By which the parts are scaled: never below their integrals, and above them by no more than the header says.
TEST_F(Disney, AlbedosOfItsPartsAreNoLessThanTheirIntegrals) {
  std::vector<float> p(static_cast<std::size_t>(disney_end), 0.0f);
  p[disney_basecolor] = 1;
  p[disney_sheen] = p[disney_clearcoat] = 1;
  for (const double cosine : {1.0, 0.9, 0.7, 0.5, 0.32, 0.2, 0.1, 0.05, 0.02, 0.005}) {
    const Vec3d o{std::sqrt(1 - cosine * cosine), 0, cosine};
    const auto c = static_cast<float>(cosine);
    const auto integral = [&](double Published::*part, int turns = 100) {
      return hemisphere([&](Vec3d i) { return published(p, 0, o, i).*part; }, turns);
    };
    const double fuzz = integral(&Published::sheen);
    EXPECT_GE(disney_fuzz_albedo(c), fuzz - 1e-5) << cosine;
    EXPECT_LE(disney_fuzz_albedo(c), fuzz + 0.0036) << cosine;
    for (const float gloss : {0.0f, 0.5f}) {
      if (cosine < 0.1) break;  // a lobe of no width, which the samples above ask for
      p[disney_clearcoatgloss] = gloss;
      const double coat = integral(&Published::coat, 1500);
      EXPECT_GE(disney_coat_albedo(c), coat - 2e-4) << cosine << ' ' << gloss;
      const double above = cosine > 0.3 ? 0.041 : 0.07;
      EXPECT_LE(disney_coat_albedo(c), coat + above) << cosine << ' ' << gloss;
    }
    for (const float roughness : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
      p[disney_roughness] = roughness;
      p[disney_subsurface] = 0;
      EXPECT_NEAR(disney_diffuse_albedo(roughness * roughness, c), integral(&Published::diffuse),
                  1e-4)
          << cosine << ' ' << roughness;
      p[disney_subsurface] = 1;
      const double below = integral(&Published::subsurface);
      EXPECT_GE(disney_subsurface_albedo(roughness, c), below - 1e-4) << cosine << ' ' << roughness;
      EXPECT_LE(disney_subsurface_albedo(roughness, c), below + (cosine > 0.3 ? 0.013 : 0.061))
          << cosine << ' ' << roughness;
    }
  }
}

}  // namespace
}  // namespace ds

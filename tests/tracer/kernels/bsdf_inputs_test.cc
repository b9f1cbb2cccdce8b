// SPDX-License-Identifier: Apache-2.0
// Every material of kernels/lists.h over all that its header says of its inputs: what each may be is
// drawn from there, the ends of the ranges included, so that a material or an input that is added is
// tried by its own rows.
#include "tests/tracer/kernels/chi_square.h"
#include "tests/tracer/kernels/direction_cells.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/base/vec.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace ds {
namespace {

using namespace kernels;
using materials::Case;
using materials::Shares;

constexpr double k_azimuth = 0.7;  // of materials::viewer

/// A draw of a material's inputs and of who looks at it.
struct Draw {
  std::vector<float> p;
  Viewer viewer;

  std::string text() const {
    return fmt::format("inputs {}, cosine {}, {}", testing::PrintToString(p), viewer.wo.z,
                       viewer.outside ? "outside" : "inside");
  }
};

class BsdfInputs : public testing::TestWithParam<Case> {
 protected:
  float number() { return kernels::unit_interval(static_cast<std::uint32_t>(random_())); }
  Draw draw(Shares shares) {
    Draw d{materials::random_inputs(GetParam(), random_, shares), {}};
    const float choice = number();
    const double cosine = choice < 0.1f   ? 1e-3
                          : choice < 0.2f ? 1.0
                                          : 1e-3 + 0.999 * double{number()};
    d.viewer = materials::viewer(cosine, number() < 0.5f);
    return d;
  }
  BsdfSample sample(const Draw& d) {
    const real2 u{number(), number()}, lobe{number(), number()};
    return GetParam().sample(d.p.data(), d.viewer, u, lobe);
  }
  BsdfValue evaluate(const Draw& d, real3 wi) {
    return GetParam().evaluate(d.p.data(), d.viewer, wi);
  }

  /// Where lobes are: half of all from the samples, half anywhere.
  real3 direction(const Draw& d) {
    if (number() < 0.5f)
      if (const BsdfSample s = sample(d); s.valid && !s.specular) return s.wi;
    const float x = number() - 0.5f, y = number() - 0.5f, z = number() - 0.3f;
    return unit(vec(x, y, z));
  }

  std::mt19937 random_{11};
};

std::string test_name(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name);
}

std::array<double, 3> channels(real3 c) {
  return {double{c.x}, double{c.y}, double{c.z}};
}

/// Means of samples' weights and their standard errors. Radiance over the square of the index is what is
/// kept (Veach 1997, 5.2).
class Means {
 public:
  void add(const BsdfSample& s) {
    ++count_;
    if (!s.valid) return;
    const auto w = channels(scale(s.weight, 1 / s.eta_scale));
    for (std::size_t i = 0; i < 3; ++i) {
      sums_[i] += w[i];
      squares_[i] += w[i] * w[i];
    }
  }
  double mean(std::size_t i) const { return sums_[i] / count_; }
  double error(std::size_t i) const {
    return std::sqrt(std::max(0.0, squares_[i] / count_ - mean(i) * mean(i)) / count_);
  }

 private:
  std::array<double, 3> sums_{}, squares_{};
  double count_ = 0;
};

TEST_P(BsdfInputs, EverythingIsFinite) {
  // Of shares beyond 1, which are warned of, nothing is promised but that nothing is NaN.
  for (int trial = 0; trial < 3000; ++trial) {
    const bool physical = trial % 3 != 0;
    const Draw d = draw(physical ? Shares::physical : Shares::any);
    const auto sound = [&](real3 c) {
      for (const double x : channels(c))
        if (!((physical ? x >= 0 : x >= -1e30) && x <= 1e30)) return false;
      return true;
    };
    for (int i = 0; i < 9; ++i) {
      const float ends[3] = {0.0f, 0.99999994f, number()};
      const BsdfSample s = GetParam().sample(d.p.data(), d.viewer, {ends[i % 3], ends[i / 3]},
                                             {ends[(i + 1) % 3], number()});
      ASSERT_TRUE(std::isfinite(s.wi.x + s.wi.y + s.wi.z)) << d.text();
      if (s.valid) {
        ASSERT_TRUE(sound(s.weight) && s.pdf >= 0 && s.pdf <= 1e30f && s.eta_scale > 0)
            << d.text() << ", weight " << s.weight.x << ", pdf " << s.pdf;
        ASSERT_NEAR(std::sqrt(double{dot(s.wi, s.wi)}), 1.0, 2e-3) << d.text();
      }
      const BsdfValue at = evaluate(d, direction(d));
      ASSERT_TRUE(sound(at.value) && at.pdf >= 0 && at.pdf <= 1e30f)
          << d.text() << ", value " << at.value.x << ", pdf " << at.pdf;
    }
    const real3 albedo = GetParam().albedo(d.p.data(), materials::viewer(1, d.viewer.outside));
    ASSERT_TRUE(sound(albedo)) << d.text() << ", albedo " << albedo.x;
  }
}

TEST_P(BsdfInputs, NoEnergyIsMadeAndNoMoreIsLostThanIsSaid) {
  const double most_lost = GetParam().type->host.most_lost;
  for (int trial = 0; trial < 160; ++trial) {
    const bool white = trial % 2 == 0;
    const Draw d = draw(white ? Shares::all : Shares::physical);
    Means means;
    for (int i = 0; i < 10000; ++i)
      means.add(sample(d));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LE(means.mean(c), 1 + 4.5 * means.error(c) + 1e-5) << d.text();
      if (!white) continue;
      EXPECT_GE(means.mean(c), 1 - most_lost - 4.5 * means.error(c) - 1e-5) << d.text();
    }
  }
}

/// At the normal, as the plane is.
TEST_P(BsdfInputs, AlbedoIsWhatIsSentOnOfLightAlongTheNormal) {
  const NodeOnHost& host = GetParam().type->host;
  int held = 0;
  for (int trial = 0; trial < 20000 && held < 60; ++trial) {
    Draw d = draw(Shares::physical);
    d.viewer = materials::viewer(1, d.viewer.outside);
    const auto albedo = channels(GetParam().albedo(d.p.data(), d.viewer));
    for (const double a : albedo)
      ASSERT_TRUE(a >= 0 && a <= 1 + host.albedo_error) << d.text() << ", albedo " << a;
    if (host.albedo_holds != nullptr && !host.albedo_holds(d.p.data(), d.viewer.outside)) continue;
    ++held;
    Means means;
    constexpr int k_samples = 20000;
    for (int i = 0; i < k_samples; ++i)
      means.add(sample(d));
    // A lobe that 20,000 samples may well miss has a share of 5e-4 at most.
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(albedo[c], means.mean(c),
                  host.albedo_error + 4.5 * means.error(c) + 10.0 / k_samples)
          << d.text();
  }
  EXPECT_EQ(held, 60);
}

/// A direction by its part along the axis across the viewer's plane, where no lobe is.
PlacedDirection place(real3 w) {
  const double x = double{w.x}, y = double{w.y};
  const double along = x * std::cos(k_azimuth) + y * std::sin(k_azimuth);
  return {y * std::cos(k_azimuth) - x * std::sin(k_azimuth), std::atan2(double{w.z}, along)};
}
real3 at_place(const PlacedDirection& p) {
  const double around = std::sqrt(std::max(0.0, 1 - p.t * p.t)), along = around * std::cos(p.phi);
  return vec(static_cast<float>(along * std::cos(k_azimuth) - p.t * std::sin(k_azimuth)),
             static_cast<float>(along * std::sin(k_azimuth) + p.t * std::cos(k_azimuth)),
             static_cast<float>(around * std::sin(p.phi)));
}

TEST_P(BsdfInputs, SamplesFollowThePdfWhichIntegratesToTheirShare) {
  constexpr int k_draws = 16, k_samples = 20000;
  const double limit = sidak(k_draws * static_cast<double>(materials::all().size()));
  int spread = 0, resolved = 0;
  for (int trial = 0; trial < 20 * k_draws && resolved < k_draws; ++trial) {
    const Draw d = draw(Shares::physical);
    // Grazing and narrow lobes would want more samples: Bsdf.SamplesFollowThePdf knows where to look.
    if (d.viewer.wo.z < 0.02f) continue;
    const auto places = [&] {
      std::vector<PlacedDirection> found;
      for (int i = 0; i < k_samples; ++i)
        if (const BsdfSample s = sample(d); s.valid && !s.specular) found.push_back(place(s.wi));
      return found;
    };
    const std::vector<PlacedDirection> first = places();
    spread += first.empty() ? 0 : 1;
    const DirectionCells cells(first);
    if (!first.empty() && cells.narrow_width() < 0.02) continue;
    resolved += first.empty() ? 0 : 1;
    std::vector<double> counts(DirectionCells::k_cells);
    double seen = 0;
    for (const PlacedDirection& at : places()) {
      counts[cells.cell(at)] += 1;
      seen += 1.0 / k_samples;
    }
    std::vector<double> expected = cells.integrals(
        [&](const PlacedDirection& at) { return double{evaluate(d, at_place(at)).pdf}; });
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected)
      e *= k_samples;
    EXPECT_NEAR(seen, total, 5 * std::sqrt(total / k_samples) + 0.005) << d.text();
    if (total > 0.01) {
      EXPECT_GT(chance_of_counts(counts, expected), limit) << d.text() << ", integral " << total;
    }
  }
  EXPECT_EQ(resolved, spread == 0 ? 0 : k_draws);
}

/// How much a number of an answer moves where the direction's floats do: at a narrow lobe much.
template <typename Ask>
double moved(real3 wi, const Ask& ask) {
  double most = 0;
  const double here = ask(wi);
  for (const float step : {-2e-7f, 2e-7f})
    for (const real3 other :
         {vec(wi.x + step, wi.y, wi.z), vec(wi.x, wi.y + step, wi.z), vec(wi.x, wi.y, wi.z + step)})
      most = std::max(most, std::fabs(ask(other) - here));
  return most;
}

TEST_P(BsdfInputs, WeightIsValueOverPdf) {
  if (GetParam().type->children > 0) GTEST_SKIP() << "a sample is weighed by the part it chose";
  for (int trial = 0; trial < 4000; ++trial) {
    const Draw d = draw(Shares::physical);
    const BsdfSample s = sample(d);
    if (!s.valid) continue;
    const BsdfValue at = evaluate(d, s.wi);
    if (s.specular) {
      ASSERT_EQ(at.pdf, 0.0f) << d.text();
      ASSERT_EQ(at.value.x, 0.0f) << d.text();
      continue;
    }
    const double pdf = double{s.pdf};
    const double unsure = moved(s.wi, [&](real3 wi) { return double{evaluate(d, wi).pdf}; });
    ASSERT_GT(pdf, 0.0) << d.text();
    ASSERT_NEAR(double{at.pdf}, pdf, 1e-3 * pdf + 8 * unsure) << d.text();
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = channels(at.value)[c];
      const double off = moved(s.wi, [&](real3 wi) { return channels(evaluate(d, wi).value)[c]; });
      ASSERT_NEAR(channels(s.weight)[c] * pdf, value,
                  1e-3 * value + 8 * off + 8 * unsure * value / pdf)
          << d.text();
    }
  }
}

TEST_P(BsdfInputs, IsReciprocal) {
  int compared = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const Draw a = draw(Shares::physical);
    const real3 wi = direction(a);
    const float side = wi.z < 0 ? -1.0f : 1.0f;
    if (std::fabs(wi.z) < 1e-3f) continue;
    // Seen from the other side the frame is turned over about its x axis.
    Draw b = a;
    b.viewer.wo = vec(wi.x, side * wi.y, side * wi.z);
    b.viewer.outside = side > 0 ? a.viewer.outside : !a.viewer.outside;
    const real3 wo = a.viewer.wo, back_wi = vec(wo.x, side * wo.y, side * wo.z);
    // What is kept on the way through is radiance over the square of the index.
    double kept = side > 0 ? 1 : 0;
    for (int i = 0; kept == 0 && i < 2000; ++i)
      if (const BsdfSample s = sample(a); s.valid && !s.specular && s.wi.z < 0) {
        kept = double{s.eta_scale};
        break;
      }
    for (std::size_t c = 0; kept > 0 && c < 3; ++c) {
      const auto ask = [&](const Draw& from, real3 towards) {
        return channels(evaluate(from, towards).value)[c];
      };
      const double scale_there = kept * double{b.viewer.wo.z}, scale_back = double{wo.z};
      const double there = ask(a, wi) / scale_there, back = ask(b, back_wi) / scale_back;
      const double unsure = moved(wi, [&](real3 w) { return ask(a, w); }) / scale_there +
                            moved(back_wi, [&](real3 w) { return ask(b, w); }) / scale_back;
      ASSERT_NEAR(there, back, 1e-3 * (there + back) + 8 * unsure + 1e-7)
          << a.text() << ", wi " << wi.x << " " << wi.y << " " << wi.z;
      compared += there > 0 ? 1 : 0;
    }
  }
  const bool dirac = compared == 0;
  for (int i = 0; dirac && i < 100; ++i)
    EXPECT_TRUE(sample(draw(Shares::physical)).specular);
}

INSTANTIATE_TEST_SUITE_P(Every, BsdfInputs, testing::ValuesIn(materials::all()), test_name);

}  // namespace
}  // namespace ds

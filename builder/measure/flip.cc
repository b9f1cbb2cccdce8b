// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/flip.h"

#include "builder/measure/channel.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace ds {
namespace {

/// The paper's constants: the exponents q_c and q_f, the fraction p_c of the largest distance that
/// is mapped to p_t, and the width of a feature in degrees.
constexpr double k_qc = 0.7, k_qf = 0.5, k_pc = 0.4, k_pt = 0.95, k_feature_deg = 0.082;

using Color = std::array<double, 3>;
using Channels = std::array<Channel, 3>;

/// Linear Rec.709 to XYZ, as exact fractions (the paper's supplement).
constexpr double k_to_xyz[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
/// Its inverse.
constexpr double k_from_xyz[3][3] = {{3.241003232976358, -1.537398969488785, -0.498615881996363},
                                     {-0.969224252202516, 1.875929983695176, 0.041554226340085},
                                     {0.055639419851975, -0.204011206123910, 1.057148977187533}};

Color times(const double (&m)[3][3], const Color& c) {
  Color out{};
  for (std::size_t row = 0; row < 3; ++row)
    out[row] = m[row][0] * c[0] + m[row][1] * c[1] + m[row][2] * c[2];
  return out;
}

double linear(std::uint8_t stored) {
  const double s = stored / 255.0;
  return s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92;
}

/// XYZ over that of white.
Color relative_xyz(const Color& rgb) {
  Color xyz = times(k_to_xyz, rgb);
  const Color white = times(k_to_xyz, {1, 1, 1});
  for (std::size_t i = 0; i < 3; ++i)
    xyz[i] /= white[i];
  return xyz;
}

Color ycxcz(const Color& rgb) {
  const Color xyz = relative_xyz(rgb);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Color rgb_of_ycxcz(const Color& c) {
  const double y = (c[0] + 16) / 116;
  const Color white = times(k_to_xyz, {1, 1, 1});
  return times(k_from_xyz,
               {(y + c[1] / 500) * white[0], y * white[1], (y - c[2] / 200) * white[2]});
}

/// L*a*b* with the chroma scaled by 0.01 L*: colours look more colourful where it is bright (Hunt
/// 1952).
Color hunt_lab(const Color& rgb) {
  constexpr double delta = 6.0 / 29;
  const auto f = [](double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const Color xyz = relative_xyz(rgb);
  const double l = 116 * f(xyz[1]) - 16;
  return {l, 0.01 * l * 500 * (f(xyz[0]) - f(xyz[1])), 0.01 * l * 200 * (f(xyz[1]) - f(xyz[2]))};
}

/// Abasi et al., "Distance metrics for very large color differences" (2020).
double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

Channels planes_of(const BytePicture& picture) {
  DS_ASSERT(picture.channels == 3);
  const Channel empty(picture.width, picture.height);
  Channels channels{empty, empty, empty};
  for (std::size_t i = 0; i < empty.values.size(); ++i) {
    const std::uint8_t* p = &picture.pixels[3 * i];
    const Color color = ycxcz({linear(p[0]), linear(p[1]), linear(p[2])});
    for (std::size_t c = 0; c < 3; ++c)
      channels[c].values[i] = color[c];
  }
  return channels;
}

/// A contrast sensitivity function as a sum of two Gaussians in degrees, a sqrt(pi / b) exp(-pi^2
/// x^2 / b) each (table 1 of the paper). A Gaussian of the channel is a product of one along x and
/// one along y.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> k_sensitivities{{
    {1, 0.0047, 0, 1e-5},       // luminance
    {1, 0.0053, 0, 1e-5},       // red to green
    {34.1, 0.04, 13.5, 0.025},  // blue to yellow
}};
constexpr double k_widest_b = 0.04;

Channel seen(const Channel& channel, const Sensitivity& s) {
  const double ppd = k_flip_pixels_per_degree;
  const int radius = static_cast<int>(
      std::ceil(3 * std::sqrt(k_widest_b / (2 * std::numbers::pi * std::numbers::pi)) * ppd));
  const auto taps = [&](double b) {
    return gaussian_taps(ppd * std::sqrt(b / (2 * std::numbers::pi * std::numbers::pi)), radius);
  };
  const auto weight = [&](double a, double b, const Taps& t) {
    double sum = 0;
    for (const double tap : t)
      sum += tap;
    return a * std::sqrt(std::numbers::pi / b) * sum * sum;
  };
  const Taps first = taps(s.b1);
  const double w1 = weight(s.a1, s.b1, first);
  Channel out = filtered(channel, normalised(first), normalised(first));
  if (s.a2 == 0) return out;
  const Taps second = taps(s.b2);
  const double w2 = weight(s.a2, s.b2, second);
  const Channel other = filtered(channel, normalised(second), normalised(second));
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = (w1 * out.values[i] + w2 * other.values[i]) / (w1 + w2);
  return out;
}

/// What the eye makes of the picture: filtered, back in the gamut, in Hunt-adjusted L*a*b*.
std::vector<Color> perceived(const Channels& channels) {
  const Channels blurred{seen(channels[0], k_sensitivities[0]),
                         seen(channels[1], k_sensitivities[1]),
                         seen(channels[2], k_sensitivities[2])};
  std::vector<Color> out(blurred[0].values.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Color rgb = rgb_of_ycxcz({blurred[0].values[i], blurred[1].values[i], blurred[2].values[i]});
    for (double& channel : rgb)
      channel = std::clamp(channel, 0.0, 1.0);
    out[i] = hunt_lab(rgb);
  }
  return out;
}

/// Positive weights add up to 1, negative ones to -1. `along` is divided by the other axis' sum
/// beforehand.
Taps balanced(Taps along) {
  double positive = 0;
  double negative = 0;
  for (const double tap : along)
    (tap > 0 ? positive : negative) += std::abs(tap);
  for (double& tap : along)
    tap /= tap > 0 ? positive : negative;
  return along;
}

enum class Feature { edge, point };

/// Length of the gradient (edges) or of the second derivatives (points) at each pixel.
std::vector<double> features(const Channel& y, Feature feature) {
  const double sigma = 0.5 * k_feature_deg * k_flip_pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const Taps gauss = gaussian_taps(sigma, radius);
  Taps along = gauss;
  double* const middle = along.data() + radius;
  for (int x = -radius; x <= radius; ++x)
    middle[x] *= feature == Feature::edge ? -x : x * x / (sigma * sigma) - 1;
  along = balanced(along);
  const Channel across = filtered(y, along, normalised(gauss));
  const Channel down = filtered(y, normalised(gauss), along);
  std::vector<double> out(across.values.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::hypot(across.values[i], down.values[i]);
  return out;
}

/// Distances to the power q_c, small ones spread out: up to p_c of the largest becomes up to p_t.
double redistributed(double distance) {
  static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), k_qc);
  const double power = std::pow(distance, k_qc);
  const double knee = k_pc * largest;
  return power < knee ? k_pt / knee * power : k_pt + (power - knee) / (largest - knee) * (1 - k_pt);
}

Channel achromatic(const Channels& channels) {
  Channel y = channels[0];
  for (double& value : y.values)
    value = (value + 16) / 116;
  return y;
}

}  // namespace

double flip(const BytePicture& reference, const BytePicture& test) {
  DS_ASSERT(reference.width == test.width && reference.height == test.height);
  const Channels r = planes_of(reference);
  const Channels t = planes_of(test);
  const std::vector<Color> seen_r = perceived(r);
  const std::vector<Color> seen_t = perceived(t);
  const Channel y_r = achromatic(r);
  const Channel y_t = achromatic(t);
  const std::vector<double> edges_r = features(y_r, Feature::edge);
  const std::vector<double> edges_t = features(y_t, Feature::edge);
  const std::vector<double> points_r = features(y_r, Feature::point);
  const std::vector<double> points_t = features(y_t, Feature::point);
  double sum = 0;
  for (std::size_t i = 0; i < seen_r.size(); ++i) {
    const double color = redistributed(hyab(seen_r[i], seen_t[i]));
    const double feature =
        std::max(std::abs(edges_r[i] - edges_t[i]), std::abs(points_r[i] - points_t[i]));
    const double weight = std::min(1.0, std::pow(feature / std::sqrt(2.0), k_qf));
    sum += std::pow(color, 1 - weight);
  }
  return sum / static_cast<double>(seen_r.size());
}

}  // namespace ds

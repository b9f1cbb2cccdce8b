// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/spectrum.h"

#include "tracer/scene/sdl_math.h"

#include <algorithm>

namespace ds {
namespace {

constexpr double k_first_nm = 382.5;
constexpr double k_step_nm = 5;
constexpr int k_steps = 80;

/// A Gaussian with one width below its centre and another above.
double lobe(double x, double centre, double below, double above) {
  const double t = (x - centre) * (x < centre ? below : above);
  return portable::exp(-0.5 * t * t);
}

Vec3d color_matching(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

double positive(double value) {
  return value > 0 ? value : 0;
}

}  // namespace

Vec3d spectrum_to_rgb(const std::function<double(double)>& spectrum) {
  Vec3d xyz;
  double luminance = 0;
  for (int i = 0; i < k_steps; ++i) {
    const double nm = k_first_nm + k_step_nm * i;
    const Vec3d matching = color_matching(nm);
    xyz = xyz + matching * spectrum(nm);
    luminance += matching.y;
  }
  xyz = xyz * (1 / luminance);
  // CIE XYZ to linear Rec.709, white D65 (ITU-R BT.709).
  return {3.240479 * xyz.x - 1.537150 * xyz.y - 0.498535 * xyz.z,
          -0.969256 * xyz.x + 1.875991 * xyz.y + 0.041556 * xyz.z,
          0.055648 * xyz.x - 0.204043 * xyz.y + 1.057311 * xyz.z};
}

double black_body_radiance(double wavelength_nm, double kelvin) {
  // 2 h c^2 and h c / k (CODATA 2018); 1e-9 turns a metre of bandwidth into a nanometre.
  constexpr double k_c1 = 1.191042972397188e-16;
  constexpr double k_c2 = 1.438776877503933e-2;
  const double l = wavelength_nm * 1e-9;
  return 1e-9 * k_c1 / (l * l * l * l * l * (portable::exp(k_c2 / (l * kelvin)) - 1));
}

Vec3d black_body_color(double kelvin, bool normalize) {
  // LuxCore's scale, measured on point lights at 3000, 6500 and 10000 K (LuxCore 2.11): the mean
  // agrees within 2 %.
  constexpr double k_normalized_scale = 0.817;
  constexpr double k_absolute_scale = 0.817 * 89160;
  // 380 to 720 nm
  constexpr double k_first = 380;
  constexpr int k_count = 69;
  double greatest = 0;
  for (int i = 0; i < k_count; ++i)
    greatest = std::max(greatest, black_body_radiance(k_first + k_step_nm * i, kelvin));
  const Vec3d rgb = spectrum_to_rgb([&](double nm) { return black_body_radiance(nm, kelvin); });
  const double scale = (normalize ? k_normalized_scale : k_absolute_scale) / greatest;
  return {positive(rgb.x) * scale, positive(rgb.y) * scale, positive(rgb.z) * scale};
}

}  // namespace ds

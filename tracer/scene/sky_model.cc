// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sky_model.h"

#include "tracer/base/hash.h"
#include "tracer/base/luminance.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sky_coefficients.h"
#include "tracer/scene/sun_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace ds {
namespace {

constexpr double k_horizon = 0.01;       // added to the cosine, so that the horizon is finite
constexpr double k_photometric = 72900;  // what LuxCore's sky2 is of the watts that were fitted

double clamped(double x, double low, double high) {
  return x < low ? low : x > high ? high : x;
}

/// Bernstein polynomials of x, 0 .. 1, of a degree one less than Count.
template <std::size_t Count>
std::array<double, Count> bernstein(double x) {
  std::array<double, Count> result{1};
  for (std::size_t n = 1; n < Count; ++n) {
    for (std::size_t k = n; k > 0; --k)
      result[k] = (1 - x) * result[k] + x * result[k - 1];
    result[0] *= 1 - x;
  }
  return result;
}

/// Share of the ground's radiance that a sky of the turbidity sends back from a height over the
/// horizon.
Vec3d backscatter(double cos_theta, double turbidity) {
  const double x = 1 - cos_theta;
  const double x4 = x * x * x * x;
  return {0.0343 + (0.0416 + 0.01416 * turbidity) * x + (0.2328 + 0.02749 * turbidity) * x4,
          0.0736 - 0.00132 * turbidity + (0.1194 + 0.01051 * turbidity) * x +
              (0.3272 + 0.00625 * turbidity) * x4,
          0.1260 + (0.2122 + 0.00073 * turbidity) * x + (0.1990 + 0.00359 * turbidity) * x4};
}

Vec3d at_horizon(Vec3d direction) {
  const Vec3d flat = normalized(Vec3d{direction.x, direction.y, 0});
  return flat == Vec3d{} ? Vec3d{1, 0, 0} : flat;
}

}  // namespace

SkyModel::SkyModel(const SkySettings& settings) : settings_(settings) {
  constexpr double k_least_elevation = portable::k_pi / 1800;  // what was fitted begins there
  const double elevation =
      std::max(portable::k_pi / 2 - portable::acos(clamped(settings.sun_direction.z, 0, 1)),
               k_least_elevation);
  const auto of_elevation = bernstein<6>(portable::pow(elevation / (portable::k_pi / 2), 1.0 / 3));
  const auto of_turbidity = bernstein<5>((settings.turbidity - 1.7) / 8.3);
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 9> at{};
    for (std::size_t k = 0; k < at.size(); ++k)
      for (std::size_t x = 0; x < of_elevation.size(); ++x)
        for (std::size_t t = 0; t < of_turbidity.size(); ++t)
          at[k] += k_sky_coefficients[i][k][x][t] * of_elevation[x] * of_turbidity[t];
    bands_[i] = {at[0], at[1], at[2], at[3], at[4], at[5], at[6], clamped(at[7], -0.98, 0.98),
                 at[8]};
  }
  const Vec3d sun =
      sun_radiance(settings.sun_direction, settings.turbidity) *
      (portable::k_pi * k_sun_sin_radius * k_sun_sin_radius * settings.sun_direction.z);
  from_ground_ = settings.ground_albedo * (sun + irradiance_of_clear_sky()) * (1 / portable::k_pi);
  Ring ring;
  const double brightness = settings.ground_autoscale ? luxcore_luminance(sky({0, 0, 1}, ring)) : 1;
  ground_ = settings.ground_color * brightness;
}

Vec3d SkyModel::clear(Vec3d direction, Ring& ring) const {
  if (ring.z != direction.z) {
    const auto gradation = [&](const Band& b) {
      return 1 + b.a * portable::exp(b.b / (direction.z + k_horizon));
    };
    ring = {direction.z,
            std::sqrt(direction.z),
            {gradation(bands_[0]), gradation(bands_[1]), gradation(bands_[2])}};
  }
  const double cos_gamma = clamped(dot(direction, settings_.sun_direction), -1, 1);
  const double gamma = portable::acos(cos_gamma);
  const double square = cos_gamma * cos_gamma;
  const auto band_radiance = [&](const Band& b, double gradation) {
    const double spread = 1 + b.h * b.h - 2 * b.h * cos_gamma;
    const double chi = (1 + square) / (spread * std::sqrt(spread));
    const double radiance = gradation * (b.c + b.d * portable::exp(b.e * gamma) + b.f * square +
                                         b.g * chi + b.i * ring.root);
    return radiance > 0 ? k_photometric * radiance : 0.0;
  };
  return {band_radiance(bands_[0], ring.gradation.x), band_radiance(bands_[1], ring.gradation.y),
          band_radiance(bands_[2], ring.gradation.z)};
}

Vec3d SkyModel::irradiance_of_clear_sky() const {
  constexpr int k_rings = 32;
  constexpr int k_sectors = 64;
  Vec3d sum;
  for (int ring = 0; ring < k_rings; ++ring) {
    // Equal steps of sin^2(theta) are equal shares of a horizontal plane's projected hemisphere.
    const double sin2 = (ring + 0.5) / k_rings;
    const double sin_theta = std::sqrt(sin2);
    Ring shared;
    for (int sector = 0; sector < k_sectors; ++sector) {
      const double phi = 2 * portable::k_pi * (sector + 0.5) / k_sectors;
      sum = sum + clear({sin_theta * portable::cos(phi), sin_theta * portable::sin(phi),
                         std::sqrt(1 - sin2)},
                        shared);
    }
  }
  return sum * (portable::k_pi / (k_rings * k_sectors));
}

Vec3d SkyModel::sky(Vec3d direction, Ring& ring) const {
  return clear(direction, ring) + from_ground_ * backscatter(direction.z, settings_.turbidity);
}

Vec3d SkyModel::radiance(Vec3d direction, Ring& ring) const {
  if (direction.z >= 0) return sky(direction, ring);
  return settings_.ground_enable ? ground_ : sky(at_horizon(direction), ring);
}

namespace {

std::string described(const SkySettings& s) {
  const auto words = [](Vec3d v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
  std::string text = fmt::format("sky2 dir {} turbidity {} groundalbedo {}", words(s.sun_direction),
                                 s.turbidity, words(s.ground_albedo));
  if (s.ground_enable)
    text += fmt::format(" ground.autoscale {} ground.color {}", s.ground_autoscale,
                        words(s.ground_color));
  return text;
}

}  // namespace

Image make_sky_image(const SkySettings& settings, int width, int height) {
  const SkyModel sky(settings);
  Image image;
  image.gamma = 1;
  image.made_from = described(settings);
  image.width = width;
  image.height = height;
  image.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  std::vector<double> cos_phi, sin_phi;
  for (int column = 0; column < width; ++column) {
    const double phi = 2 * portable::k_pi * (0.5 - (column + 0.5) / width);
    cos_phi.push_back(portable::cos(phi));
    sin_phi.push_back(portable::sin(phi));
  }
  SkyModel::Ring ring;
  for (int row = 0; row < height; ++row) {
    const double theta = portable::k_pi * (row + 0.5) / height;
    const double sin_theta = portable::sin(theta);
    const double cos_theta = portable::cos(theta);
    for (std::size_t i = 0; i < cos_phi.size(); ++i) {
      const Vec3 rgb =
          to_float(sky.radiance({sin_theta * cos_phi[i], sin_theta * sin_phi[i], cos_theta}, ring));
      image.rgb.insert(image.rgb.end(), {rgb.x, rgb.y, rgb.z});
    }
  }
  image.content = hash_bytes(std::as_bytes(std::span(image.rgb)));
  return image;
}

}  // namespace ds

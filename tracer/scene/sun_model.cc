// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sun_model.h"

#include "tracer/scene/sdl_math.h"
#include "tracer/scene/spectrum.h"

#include <algorithm>

namespace ds {
namespace {

/// Share of the light that a clear atmosphere lets through: Rayleigh scattering, Angstrom's
/// turbidity formula and ozone as Preetham, Shirley and Smits, "A Practical Analytic Model for
/// Daylight" (SIGGRAPH 1999), appendix A.1, give them (after Iqbal 1983). Water vapour and mixed
/// gases absorb outside the range that counts for colour.
double transmittance(double nm, double mass, double turbidity) {
  const double um = nm * 1e-3;
  const double beta = 0.04608365822050 * turbidity - 0.04586025928522;
  const double rayleigh = 0.008735 * portable::pow(um, -4.08);
  const double aerosol = beta * portable::pow(um, -1.3);
  // Ozone, 0.35 cm: its Chappuis band as one Gaussian instead of a table.
  const double from_peak = (nm - 598.0) / 40.0;
  const double ozone = 0.35 * 0.118 * portable::exp(-0.5 * from_peak * from_peak);
  return portable::exp(-(rayleigh + aerosol + ozone) * mass);
}

}  // namespace

double air_mass(double sin_elevation) {
  const double zenith_deg = portable::acos(sin_elevation) * (180.0 / portable::k_pi);
  return 1 / (sin_elevation + 0.15 * portable::pow(93.885 - zenith_deg, -1.253));
}

Vec3d sun_radiance(Vec3d direction, double turbidity) {
  const double mass = air_mass(direction.z > 1 ? 1 : direction.z);
  // The sun above the atmosphere as a black body of its effective temperature, 683 lm/W, integral
  // of the luminosity function 106.9 nm. The last factors take the black body's colour to that of
  // LuxCore's solar spectrum, fitted at turbidity 2.2 and elevation 45 degrees (LuxCore 2.11);
  // elsewhere they hold within 3 % above 15 degrees.
  constexpr double k_photometric = 683.0 * 106.9;
  constexpr Vec3d k_solar_tint{0.9763, 1.0059, 1.1361};
  const Vec3d rgb = spectrum_to_rgb([&](double nm) {
    return black_body_radiance(nm, 5778) * transmittance(nm, mass, turbidity);
  });
  return Vec3d{std::max(0.0, rgb.x), std::max(0.0, rgb.y), std::max(0.0, rgb.z)} * k_solar_tint *
         k_photometric;
}

}  // namespace ds

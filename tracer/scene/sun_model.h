// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

namespace ds {

/// Radiance of the sun's disc through a clear atmosphere, linear Rec.709, photometric like
/// LuxCore's sun (lm/(m^2 sr); about 1e9). `direction` is unit, towards the sun, its z at least 0;
/// `turbidity` 1 .. 30. The disc is uniform. Same bits everywhere.
Vec3d sun_radiance(Vec3d direction, double turbidity);

/// Sine of the angular radius of the sun as seen from the earth: 695 500 km / 149.6e6 km.
inline constexpr double k_sun_sin_radius = 695500.0 / 149.6e6;

/// Relative optical air mass for a sine of the elevation, as Preetham, Shirley and Smits (1999),
/// eq. 18 after Kasten (1966): 1 at the zenith, about 39 at the horizon.
double air_mass(double sin_elevation);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <functional>

namespace ds {

/// Linear Rec.709 of a spectrum over 380 .. 780 nm: CIE 1931 colour matching by the multi-lobe fit
/// of Wyman, Sloan and Shirley (JCGT 2(2), 2013, eq. 4), midpoint rule in steps of 5 nm, scaled so
/// that the spectrum 1 has luminance 1. A colour outside the gamut keeps its negative component.
Vec3d spectrum_to_rgb(const std::function<double(double wavelength_nm)>& spectrum);

/// Planck's law, W/(m^2 sr nm). `kelvin` above 0.
double black_body_radiance(double wavelength_nm, double kelvin);

/// LuxCore's `temperature`: the colour of a black body, its spectrum scaled to a greatest value of
/// 1 in the visible range where `normalize`, else in LuxCore's absolute unit. Components are not
/// negative.
Vec3d black_body_color(double kelvin, bool normalize);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

namespace ds {

/// Linear Rec.709 (white D65) of a black body of so many kelvin, in [1667, 25000], scaled to luminance 1:
/// about (1, 1, 1) at 6500. What lies out of the gamut, blue below 1900, is 0. From + - * / only: the same
/// bits on every machine.
/// Chromaticity: cubic fit of the Planckian locus by Kim et al., Design of Advanced Color Temperature
/// Control System for HDTV Applications, J. Korean Phys. Soc. 41 (2002) 865, eqs. 8 and 9.
Vec3d black_body_colour(double temperature_k);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ds {

/// Sine and cosine of an angle in degrees, finite and within +-1e6. From + - * / only, so that the
/// bits are the same on every machine (a C library's own are not); exact at multiples of 90, else
/// within 2 ulp of a result of size 1.
double sin_deg(double degrees);
double cos_deg(double degrees);

}  // namespace ds

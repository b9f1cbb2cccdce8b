// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ds {

/// Share of the standard normal distribution below x; the same bits on every machine. Relative error
/// below 1e-13 for x in [-38, 38].
double normal_below(double x);
/// The x that a share p in (0, 1) is below: Wichura's PPND16 (Applied Statistics 37, 1988, algorithm
/// AS 241), relative error about 1e-16. Infinite at 0 and 1.
double normal_at(double p);

}  // namespace ds

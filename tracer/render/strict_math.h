// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace ds {

/// Elementary functions with the same bits on every machine, which libm's have not: series of sums,
/// products and quotients only, so they need -ffp-contract=off and nothing else. Relative error
/// below 1e-15 for log and exp; below 1e-15 * (1 + |y log x|) for pow, which is 1e-13 for x in
/// [1e-9, 1e9] and |y| <= 4.

/// Natural logarithm of a finite x > 0 (denormals too).
double strict_log(double x);
/// e^x. 0 below -745, infinite above 709.8.
double strict_exp(double x);
/// x^y for finite x >= 0 and finite y; 0^y is 0 for y > 0 and x^1 is x. x = 0 with y <= 0 is a bug.
double strict_pow(double x, double y);

}  // namespace ds

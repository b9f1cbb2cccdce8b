// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

/// Elementary functions whose bits are the same on every machine: + - * / and sqrt in double, no
/// libm. What the scene reader computes (sky pictures, rotations, spectra) ends in pixels, and
/// libm's last bit differs between versions and CPU levels. Relative error below 1e-14 in the
/// stated domains.
namespace ds::portable {

inline constexpr double k_pi = 3.141592653589793;

double exp(double x);              ///< overflows to infinity, underflows to 0
double log(double x);              ///< x > 0
double pow(double x, double y);    ///< x >= 0; pow(0, y) is 0 for y > 0 and 1 for y = 0
double sin(double x);              ///< |x| <= 1000 (absolute error 1e-13)
double cos(double x);              ///< |x| <= 1000 (absolute error 1e-13)
double atan2(double y, double x);  ///< (-pi, pi]; 0 for the origin
double acos(double x);             ///< |x| <= 1; 0 .. pi

inline double radians(double degrees) {
  return degrees * (k_pi / 180.0);
}

/// Inverse of an affine matrix. `determinant` of the upper 3x3 must not be 0.
Mat4 inverse(const Mat4& m);
double determinant(const Mat4& m);
/// A normal moved as the surface is: the inverse transpose of the upper 3x3, unit length.
Vec3d transform_normal(const Mat4& inverse_of_m, Vec3d normal);

}  // namespace ds::portable

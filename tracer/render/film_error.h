// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/pixel_filter.h"
#include "tracer/render/render.h"

#include <optional>
#include <span>

namespace ds {

/// A root mean squared error and its 95 % interval.
struct ErrorEstimate {
  double value = 0, low = 0, high = 0;
};

/// The RMS error of a picture from its own samples. A pixel's even and odd samples are two
/// independent estimates A and B of it, scrambled apart (kernels/sampler.h). Their mean is the
/// pixel; half their difference d = (A - B) / 2 has the variance of that mean, so the mean of d^2
/// over the pixels estimates the mean squared error without bias, whatever the distribution.
///
/// The interval is of the error this picture has, not of its expectation. With a = A - truth and
/// b = B - truth a pixel's squared error is ((a + b) / 2)^2 = d^2 + a b, and a b has mean 0 and
/// variance (2 v)^2, v the variance of the pixel's mean. So the picture's mean squared error over
/// its estimate is about log-normal with a standard deviation of 2 / sqrt(n), n = (sum v)^2 / sum
/// v^2 the number of pixels that carry the error. d is half the difference of two equal variables,
/// so E(d^4) >= 2 v^2 whatever their distribution (3 v^2 for a normal one), and 2 (sum d^2)^2 / sum
/// d^4 does not overstate n. Pixels that share samples err alike: the products a b of two whose
/// noise has the correlation r have that of r^2, so n pixels tell as much as n over the sum of r^2
/// over a pixel and all others (PixelFilter::correlation). What no sample has met, such as a
/// caustic too small to be found, cannot be known here: the error is then above the interval.
/// Tested in tests/render/film_error_test.cc: over 200 small renders it holds the true error of 90
/// to 99 %, and every miss but a few is of that kind.
class ErrorSum {
 public:
  /// `squared`: d^2 of a pixel, summed over its channels.
  void add(double squared) {
    sum_ += squared;
    sum_of_squares_ += squared * squared;
  }
  ErrorSum& operator+=(const ErrorSum& other) {
    sum_ += other.sum_;
    sum_of_squares_ += other.sum_of_squares_;
    return *this;
  }
  /// `scale`: what the mean squared error's root is to be divided by; `count`: of values added up;
  /// `correlation`: PixelFilter::correlation.
  ErrorEstimate estimate(double scale, double count, double correlation) const;
  double sum() const { return sum_; }

 private:
  double sum_ = 0, sum_of_squares_ = 0;
};

/// Of the linear picture's luminance, over its mean. 0 for a black film. Nothing for a film without
/// halves: a single sample a pixel tells nothing of its error.
std::optional<ErrorEstimate> luminance_error(const Film& film, const PixelFilter& filter);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/render.h"

#include <optional>

namespace ds {

/// A reference is two films of one picture, traced with different seeds, so that its own noise does
/// not count as the error of what is compared with it: the mean of (x - a)(x - b) over pixels is
/// the mean square error of x without bias, since the noise of a, of b and of x are independent. It
/// can come out negative where x is as good as the reference; callers say so instead of taking its
/// root.
struct Reference {
  Film a, b;
};

/// Errors of a film's linear radiance. Each is relative, so the light's unit does not matter.
struct LinearErrors {
  /// Mean square error of luminance (Rec.709) over the square of the mean luminance: the square of
  /// what `Film::relative_error` estimates.
  double mean_square = 0;
  /// relMSE: mean over pixels and channels of (x - r)^2 / (r^2 + e), with e = 0.01 times the square
  /// of the mean luminance in place of the constant 0.01 of Rousselle et al., "Adaptive sampling
  /// and reconstruction using greedy error minimization" (2011), eq. 14, whose scenes have radiance
  /// near 1.
  double rel_mse = 0;
  /// relMSE without the thousandth of the pixels that are farthest off, at least one: what is left
  /// of it without fireflies.
  double rel_mse_trimmed = 0;
};

/// All three films are of one size and hold a pixel. 0 throughout where the reference is black.
LinearErrors linear_errors(const Film& film, const Reference& reference);

/// Mean square error of developed pictures, in (units of 8 bit)^2 over pixels and channels, by two
/// references as above.
double picture_mean_square(const BytePicture& picture, const BytePicture& a, const BytePicture& b);
/// Peak signal-to-noise ratio in dB: 10 log10(255^2 / mean_square); nothing where mean_square <= 0:
/// the pictures cannot be told apart.
std::optional<double> psnr_db(double mean_square);

/// The mean of (x1 - a)(x2 - b) over pixels, over the square of the mean luminance. x1 and x2 are
/// traced with different seeds too, so that neither film's noise counts: what is left is the square
/// of the relative RMS difference between the pictures both would become with samples without end.
struct BiasSquare {
  double value = 0;           ///< negative by chance where the difference is lost in the noise
  double standard_error = 0;  ///< of `value`, from the scatter of the pixels
};
BiasSquare relative_bias_square(const Film& x1, const Film& x2, const Reference& reference);

/// Mean luminance (Rec.709) of a film.
double mean_luminance(const Film& film);

}  // namespace ds

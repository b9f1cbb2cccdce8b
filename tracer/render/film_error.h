// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

namespace ds {

/// Relative RMS error of a film's luminance, estimated from its own samples.
///
/// A pixel's even and odd samples are two independent estimates of it, A and B, of equal variance.
/// The pixel is their mean, whose variance (A - B)^2 / 4 estimates without bias. The result is
/// sqrt(mean variance) / mean luminance over all pixels: thousands of independent degrees of
/// freedom although each pixel has one.
///
/// `rgb`: three floats a pixel, the means. `halves`: one a pixel, the sum of the even samples'
/// luminance minus that of the odd ones. With an odd `spp` the longer half's surplus sample is
/// taken to be the mean. Nothing for spp = 1.
std::optional<double> relative_error(std::span<const float> rgb, std::span<const float> halves,
                                     int spp);

}  // namespace ds

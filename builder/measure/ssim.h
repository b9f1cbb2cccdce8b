// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"

#include <optional>

namespace ds {

/// Mean structural similarity of two developed pictures of one size, 1 where they are equal: Wang,
/// Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to structural
/// similarity" (2004), eq. 13, with their constants: Gaussian window of 11x11 and sigma 1.5, K1 =
/// 0.01, K2 = 0.03, on luma (0.2126 R + 0.7152 G + 0.0722 B of the encoded values), over the
/// windows that lie in the picture. Nothing for a picture that holds no such window.
std::optional<double> ssim(const BytePicture& x, const BytePicture& y);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"

namespace ds {

/// Pixels a degree of the viewing angle: the paper's default, a display of 0.7 m and 3840 pixels
/// seen from 0.7 m.
inline constexpr double k_flip_pixels_per_degree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

/// How different a person who flips between two developed pictures finds them: 0 (the same) to 1,
/// the mean of the error map of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild,
/// "FLIP: a difference evaluator for alternating images" (2020). All of it for 8-bit pictures: the
/// contrast sensitivity filters, Hunt-adjusted L*a*b*, the HyAB distance and its redistribution
/// (section 4.1), edge and point detection (4.2), their combination (4.3). Not the later HDR
/// extension. Not symmetric in the last digits only; `reference` comes first by custom. The
/// pictures are of one size; values are taken as sRGB.
double flip(const BytePicture& reference, const BytePicture& test);

}  // namespace ds

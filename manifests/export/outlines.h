// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

#include <array>
#include <vector>

namespace ds {

/// The mask as one closed polygon of pixel corners [x, y], whose pieces and holes are tied by lines that are
/// walked there and back: what is inside by the even-odd rule are exactly the mask's pixels. Corners stand
/// where the outline turns. Empty for an empty mask.
std::vector<std::array<int, 2>> outline_of(const MaskPixels& mask);

}  // namespace ds

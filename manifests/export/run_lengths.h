// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ds {

/// COCO's run lengths of a mask: down the columns from the left, first of zeros, then of ones, and so
/// on; the first is 0 where the first pixel is set.
std::vector<std::uint32_t> run_lengths(const MaskPixels& mask);
/// As pycocotools' string: from the fourth run on the difference to the run two before, five bits a
/// character, the least first, bit 5 where more follow, the sign in the last one's bit 4, plus 48.
std::string run_length_text(const std::vector<std::uint32_t>& runs);
/// Pixels that are set.
std::uint64_t area_of(const MaskPixels& mask);

}  // namespace ds

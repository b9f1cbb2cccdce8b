// SPDX-License-Identifier: Apache-2.0
// The table of the guide to caustics (guide.h), as word offsets that host and device share.
#pragma once

#include "tracer/kernels/language.h"

/// The guide's table (guide.h): a head, a cell for each place of a cube row by row, then the cells'
/// lobes. A cell is the offset of its lobes, or 0.
enum {
  k_guide_side = 0,       ///< cells along an edge
  k_guide_origin = 1,     ///< 3: the cube's low corner, world, metres
  k_guide_per_metre = 4,  ///< cells
  k_guide_nowhere = 8,    ///< lobes of no weight
  k_guide_lobes = 4,      ///< of a cell
  k_guide_radius2 = 3,    ///< of a lobe: its sphere's centre, squared radius, and share
  k_guide_weight = 4,
  k_guide_lobe_words = 5,
  k_guide_cells = k_guide_nowhere + k_guide_lobes * k_guide_lobe_words,
};

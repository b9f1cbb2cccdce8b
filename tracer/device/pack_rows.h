// SPDX-License-Identifier: Apache-2.0
// Rows of the tables in the making, for scene_pack.cc and the pack_*.cc between themselves.
#pragma once

#include "tracer/device/scene_pack.h"

#include <string_view>
#include <vector>

namespace ds {

/// One light's row.
struct LightRow {
  std::string_view kind;
  double weight = 0;  ///< share of next-event estimation before normalising; 0: never sampled
  Words parameters;
};

/// Appends cumulative shares as floats; the last of positive share and all behind it are exactly 1.
void add_cumulative(const std::vector<double>& weights, Words& tables);

/// Row and tables of a lat-long image at infinity (kernels/lights/infinite.h). Texels that a shared
/// exponent of 8 bits and mantissas of 8 bits hold exactly, as those of .hdr files are, are kept in
/// one word each. `cache` may be null.
LightRow infinite_row(const Scene& scene, const Light& light, double scene_radius, PackCache* cache,
                      Words& tables);

/// Rows of colours in the tables (kernels/scene_data.h), and their offset; none where no texture of the
/// program reads them.
std::uint32_t pack_colors(const Scene& scene, const Features& features, Words& tables);

}  // namespace ds

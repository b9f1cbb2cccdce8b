// SPDX-License-Identifier: Apache-2.0
// Rows of the tables in the making, for scene_pack.cc and the pack_*.cc between themselves.
#pragma once

#include "tracer/device/scene_pack.h"
#include "tracer/kernels/lists.h"

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

/// Row and tables of lights with k_host_tables, in pack_NAME.cc. `cache` may be null.
#define DS_DECLARE_PACK(sdl_name, prefix)                                             \
  LightRow pack_##prefix(const Scene& scene, const Light& light, double scene_radius, \
                         PackCache* cache, Words& tables);
DS_SCENE_LIGHTS(DS_DECLARE_PACK)
#undef DS_DECLARE_PACK

/// Rows of colours in the tables (kernels/scene_data.h), and their offset; none where no texture of the
/// program reads them.
std::uint32_t pack_colors(const Scene& scene, const SceneEffects& effects, Words& tables);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/base/kept.h"
#include "tracer/device/tie_places.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// Which triangles of different objects lie in one plane, as nearly as rays can tell, and overlap
/// there: what kernels/ties.cl decides by rank.
struct Ties {
  /// By triangle: what k_triangle_flags holds of it (kernels/scene_data.h), 0 for one without.
  std::vector<std::uint32_t> flags;
  /// Boxes, k_most_tie_places at most, that hold all places where triangles tie, with a margin.
  std::vector<TiePlace> places;
};

/// Triangles of different objects that tie, whatever lies on what.
struct TiePairs {
  std::vector<std::array<std::uint32_t, 2>> pairs;
};
inline std::size_t bytes_held(const TiePairs& of) {
  return of.pairs.size() * sizeof(of.pairs[0]) + sizeof of;
}

/// `triangles`: those of the scene's objects, one behind the other; `bvh`: their tree. `cache`, where
/// there is one, knows the pairs among all objects but the last: scenes of one environment have them
/// in common.
///
/// Ranks: models lie on top, then what shines, then the object of lesser area (a carpet lies on the
/// floor, not under it), then the earlier one.
Ties find_ties(const Scene& scene, std::span<const std::array<Vec3, 3>> triangles, const Bvh& bvh,
               Kept<TiePairs>* cache = nullptr);

}  // namespace ds

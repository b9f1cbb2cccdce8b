// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/scene/scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// Which triangles of different objects lie in one plane, as nearly as rays can tell, and overlap
/// there: what kernels/ties.cl decides by rank.
struct Ties {
  /// By triangle: what k_triangle_flags holds of it (kernels/scene_data.h), 0 for one without.
  std::vector<std::uint32_t> flags;
  /// Bounds of all places where triangles tie, with a margin; low above high where there are none.
  std::array<float, 3> low, high;
};

/// `triangles`: those of the scene's objects, one behind the other; `bvh`: their tree.
///
/// Ranks: models lie on top, then what shines, then the object of lesser area (a carpet lies on the
/// floor, not under it), then the earlier one.
Ties find_ties(const Scene& scene, std::span<const std::array<Vec3, 3>> triangles, const Bvh& bvh);

}  // namespace ds

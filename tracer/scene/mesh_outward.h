// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh_topology.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// What was found of triangles that run the wrong way round.
struct WindingReport {
  std::uint64_t turned = 0;  ///< of closed surfaces, turned round
  /// Of open surfaces, against the majority of theirs; left as they are.
  std::uint64_t against = 0;
};

/// Turns the triangles of closed surfaces so that they face outwards. A surface is what edges of
/// exactly two triangles join; it is closed where every edge has as many triangles on one side as
/// on the other, once they are wound alike, and its volume is told from 0. Then its outside is
/// known: a positive volume, whichever way its faces run, all or some of them.
///
/// A closed surface inside another may be a hollow or a body of its own, and only the winding tells
/// which: it keeps its side relative to the outermost one around it, so that a file turned inside
/// out as a whole is the same as the file. (A thousand surfaces of each winding, the largest, are
/// looked at as the outermost one.)
///
/// Where a surface is open because places along a seam differ in their last digits, it is looked at
/// again with these welded (weld_seams).
///
/// `welded`: weld's of `positions`. `flat`: triangles without area that may join others over a
/// T-shaped contact; they have three places for corners. Sums in double, in the order of the
/// triangles.
WindingReport turn_outwards(std::span<const Vec3d> positions, std::span<const std::uint32_t> welded,
                            std::vector<Triangle>& triangles, std::span<const Triangle> flat = {});

}  // namespace ds

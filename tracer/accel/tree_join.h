// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"

#include <cstdint>
#include <optional>

namespace ds {

/// `tree` with all of `inserted` as one subtree, where that makes boxes grow least. The inserted
/// triangles' ids are counted from `first` on, which is above the ids of `tree`. A node gets at most
/// `width` children. Nothing where it would be deeper than kernels go.
std::optional<WideTree> join_trees(const WideTree& tree, const WideTree& inserted,
                                   std::uint32_t first, int width);

}  // namespace ds

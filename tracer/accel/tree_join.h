// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/binary_tree.h"

namespace ds {

/// One tree of two: `inserted` stands in `tree` where that makes the boxes above it grow the least.
/// Its triangles' numbers grow by `first`. Rays pass it about as quickly as a tree that was built of
/// all triangles, where `inserted` is small beside what `tree` holds or lies apart from it, as a
/// model does in its environment.
std::vector<BinaryNode> join_trees(const std::vector<BinaryNode>& tree,
                                   const std::vector<BinaryNode>& inserted, std::uint32_t first);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/tree_join.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <limits>

namespace ds {
namespace {

NodeBox around(const NodeBox& a, const NodeBox& b) {
  NodeBox both;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.low[axis] = std::min(a.low[axis], b.low[axis]);
    both.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return both;
}

/// The node to stand beside, and whether each node is above it.
struct Place {
  std::uint32_t beside = 0;
  std::vector<bool> above;
};

/// Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies", section 3.2: the cost is the box of the new parent and what those above it grow
/// by, and no place below a node costs less than what was added above and the box itself.
Place cheapest_place(const std::vector<BinaryNode>& tree, const NodeBox& box) {
  struct Visit {
    std::uint32_t node;
    float grown;  ///< by the nodes above it
  };
  const auto root = static_cast<std::uint32_t>(tree.size() - 1);
  Place place;
  float least = std::numeric_limits<float>::infinity();
  std::vector<Visit> stack{{root, 0}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (!(visit.grown + box.half_area() < least)) continue;
    const BinaryNode& node = tree[visit.node];
    const float parent = around(node.bounds, box).half_area();
    if (visit.grown + parent < least) {
      least = visit.grown + parent;
      place.beside = visit.node;
    }
    if (node.leaf_count == 1) continue;
    const float grown = visit.grown + parent - node.bounds.half_area();
    stack.push_back({node.right, grown});
    stack.push_back({node.left, grown});
  }
  // Children stand before their parents.
  place.above.assign(tree.size(), false);
  std::vector<bool> holds(tree.size(), false);
  holds[place.beside] = true;
  for (std::size_t i = place.beside + std::size_t{1}; i < tree.size(); ++i) {
    if (tree[i].leaf_count == 1) continue;
    holds[i] = place.above[i] = holds[tree[i].left] || holds[tree[i].right];
  }
  return place;
}

}  // namespace

std::vector<BinaryNode> join_trees(const std::vector<BinaryNode>& tree,
                                   const std::vector<BinaryNode>& inserted, std::uint32_t first) {
  DS_ASSERT(!tree.empty() && !inserted.empty());
  const BinaryNode& guest = inserted.back();
  const Place place = cheapest_place(tree, guest.bounds);
  std::vector<BinaryNode> joined;
  joined.reserve(tree.size() + inserted.size() + 1);
  std::vector<std::uint32_t> now(tree.size());  ///< where each node of `tree` is
  const auto add = [&](BinaryNode node) {
    joined.push_back(node);
    return static_cast<std::uint32_t>(joined.size() - 1);
  };
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    BinaryNode node = tree[i];
    const auto own = static_cast<std::uint32_t>(joined.size());
    const bool is_leaf = node.leaf_count == 1;
    node.left = is_leaf ? own : now[node.left];
    node.right = is_leaf ? own : now[node.right];
    if (place.above[i]) {
      node.bounds = around(node.bounds, guest.bounds);
      node.leaf_count += guest.leaf_count;
    }
    now[i] = add(node);
    if (i != place.beside) continue;
    const auto base = static_cast<std::uint32_t>(joined.size());
    for (BinaryNode moved : inserted) {
      moved.left += base;
      moved.right += base;
      moved.triangle += first;
      add(moved);
    }
    BinaryNode parent;
    parent.bounds = around(node.bounds, guest.bounds);
    parent.left = now[i];
    parent.right = static_cast<std::uint32_t>(joined.size() - 1);
    parent.leaf_count = node.leaf_count + guest.leaf_count;
    now[i] = add(parent);
  }
  return joined;
}

}  // namespace ds

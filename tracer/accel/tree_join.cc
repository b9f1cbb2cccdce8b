// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/tree_join.h"

#include "tracer/accel/binary_tree.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <vector>

namespace ds {
namespace {

using namespace kernels;

constexpr std::size_t k_slots = k_bvh_width;
constexpr std::size_t k_node_floats = k_node_vectors * k_slots;
constexpr std::size_t k_leaf_floats = k_leaf_vectors * k_slots;
constexpr std::uint32_t k_leaf_bit = 0x80000000u;
constexpr std::uint32_t k_no_place = 0xffffffffu;

NodeBox around(const NodeBox& a, const NodeBox& b) {
  NodeBox both;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    both.low[axis] = std::min(a.low[axis], b.low[axis]);
    both.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return both;
}

const float* node_at(const Bvh& bvh, std::uint32_t node) {
  return bvh.nodes.data() + std::size_t{node} * k_node_floats;
}
float* node_at(Bvh& bvh, std::uint32_t node) {
  return bvh.nodes.data() + std::size_t{node} * k_node_floats;
}

NodeBox child_box(const float* node, std::size_t i) {
  NodeBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = node[2 * axis * k_slots + i];
    box.high[axis] = node[(2 * axis + 1) * k_slots + i];
  }
  return box;
}
std::uint32_t child_reference(const float* node, std::size_t i) {
  return std::bit_cast<std::uint32_t>(node[k_node_children * k_slots + i]);
}
void set_child(float* node, std::size_t i, const NodeBox& box, std::uint32_t reference) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node[2 * axis * k_slots + i] = box.low[axis];
    node[(2 * axis + 1) * k_slots + i] = box.high[axis];
  }
  node[k_node_children * k_slots + i] = std::bit_cast<float>(reference);
}
/// Children stand in the first places; absent ones are inside out.
std::size_t child_count(const float* node) {
  std::size_t count = 0;
  while (count < k_slots && node[count] <= node[k_slots + count])
    ++count;
  return count;
}

NodeBox root_box(const Bvh& bvh) {
  const float* at = bvh.nodes.data() + k_root_bounds * k_slots;
  return {{at[0], at[1], at[2]}, {at[3], at[4], at[5]}};
}
void set_root_box(Bvh& bvh, const NodeBox& box) {
  float* at = bvh.nodes.data() + k_root_bounds * k_slots;
  std::copy(box.low.begin(), box.low.end(), at);
  std::copy(box.high.begin(), box.high.end(), at + 3);
}

/// A node on the way down.
struct Visit {
  std::uint32_t node;
  std::uint32_t parent;  ///< number of its parent's visit, or k_no_place
  std::size_t slot;      ///< its place among the parent's children
  unsigned depth;
  NodeBox box;
  float grown;  ///< by the nodes above it
};

/// Where to insert: as further children of a node, or beside one of its children below a new node.
struct Place {
  std::uint32_t visit = k_no_place;
  std::optional<std::size_t> beside;
  bool unfolded = false;  ///< the children of the inserted root in its place
};

/// Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies", section 3.2, for nodes of several children: the cost is what boxes grow by and the
/// box of a new node, and no place below a node costs less than what it and those above grow by.
class PlaceSearch {
 public:
  PlaceSearch(const WideTree& tree, const WideTree& inserted, std::size_t width)
      : bvh_(tree.bvh),
        box_(root_box(inserted.bvh)),
        guests_(child_count(node_at(inserted.bvh, 0))),
        width_(width),
        deepest_as_child_(k_bvh_depth - std::min<unsigned>(inserted.levels, k_bvh_depth)),
        room_for_a_level_(tree.levels < k_bvh_depth) {
    visits_.push_back({0, k_no_place, 0, 1, root_box(bvh_), 0});
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
      const std::uint32_t number = open.back();
      open.pop_back();
      look(number, open);
    }
  }
  const Place& place() const { return place_; }
  const Visit& visit(std::uint32_t number) const { return visits_[number]; }
  const NodeBox& box() const { return box_; }

 private:
  void look(std::uint32_t number, std::vector<std::uint32_t>& open) {
    const Visit visit = visits_[number];
    const float grown = visit.grown + around(visit.box, box_).half_area() - visit.box.half_area();
    if (!(grown < least_)) return;
    const float* node = node_at(bvh_, visit.node);
    const std::size_t count = child_count(node);
    if (visit.depth <= deepest_as_child_) add(count, grown, {number, std::nullopt});
    for (std::size_t i = 0; i < count; ++i) {
      const NodeBox box = child_box(node, i);
      if (room_for_a_level_ && visit.depth < deepest_as_child_)
        add(1, grown + around(box, box_).half_area(), {number, i});
      if ((child_reference(node, i) & k_leaf_bit) != 0) continue;
      open.push_back(static_cast<std::uint32_t>(visits_.size()));
      visits_.push_back({child_reference(node, i), number, i, visit.depth + 1, box, grown});
    }
  }
  /// Below a node of `count` other children.
  void add(std::size_t count, float cost, Place place) {
    place.unfolded = count + guests_ <= width_;
    if (!place.unfolded) cost += box_.half_area();
    if (count >= width_ || !(cost < least_)) return;
    least_ = cost;
    place_ = place;
  }

  const Bvh& bvh_;
  NodeBox box_;
  std::size_t guests_;  ///< children of the inserted root
  std::size_t width_;
  unsigned deepest_as_child_;  ///< depth of a node that the inserted tree fits below
  bool room_for_a_level_;
  float least_ = std::numeric_limits<float>::infinity();
  Place place_;
  std::vector<Visit> visits_;
};

/// What references of the inserted tree grow by.
struct Offsets {
  std::uint32_t nodes, leaves;
  std::uint32_t moved(std::uint32_t reference) const {
    return reference + ((reference & k_leaf_bit) != 0 ? leaves : nodes);
  }
};

/// The inserted tree behind the other in the tables, without its root where that is unfolded.
Offsets append(const Bvh& inserted, bool unfolded, std::uint32_t first, Bvh& bvh) {
  const auto nodes = static_cast<std::uint32_t>(bvh.nodes.size() / k_node_floats);
  const auto leaves = static_cast<std::uint32_t>(bvh.leaves.size() / k_leaf_floats);
  const Offsets offsets{unfolded ? nodes - 1 : nodes, leaves};
  const std::size_t own_nodes = bvh.nodes.size(), own_leaves = bvh.leaves.size();
  bvh.nodes.insert(bvh.nodes.end(),
                   inserted.nodes.begin() + (unfolded ? std::ptrdiff_t{k_node_floats} : 0),
                   inserted.nodes.end());
  bvh.leaves.insert(bvh.leaves.end(), inserted.leaves.begin(), inserted.leaves.end());
  for (std::size_t at = own_nodes; at < bvh.nodes.size(); at += k_node_floats) {
    float* node = bvh.nodes.data() + at;
    const std::size_t count = child_count(node);
    for (std::size_t i = 0; i < count; ++i)
      node[k_node_children * k_slots + i] =
          std::bit_cast<float>(offsets.moved(child_reference(node, i)));
  }
  for (std::size_t at = own_leaves; at < bvh.leaves.size(); at += k_leaf_floats) {
    float* ids = bvh.leaves.data() + at + k_leaf_ids * k_slots;
    // They ascend; absent ones behind them are 0.
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < k_slots; ++i) {
      const auto id = std::bit_cast<std::uint32_t>(ids[i]);
      if (i > 0 && id <= before) break;
      before = id;
      ids[i] = std::bit_cast<float>(id + first);
    }
  }
  return offsets;
}

/// Behind the children that the node has.
void add_guest(const Bvh& inserted, bool unfolded, const Offsets& offsets, float* node) {
  std::size_t place = child_count(node);
  if (!unfolded) return set_child(node, place, root_box(inserted), offsets.moved(0));
  const float* root = node_at(inserted, 0);
  const std::size_t count = child_count(root);
  for (std::size_t i = 0; i < count; ++i)
    set_child(node, place++, child_box(root, i), offsets.moved(child_reference(root, i)));
}

}  // namespace

std::optional<WideTree> join_trees(const WideTree& tree, const WideTree& inserted,
                                   std::uint32_t first, int width) {
  const PlaceSearch search(tree, inserted, static_cast<std::size_t>(width));
  const Place place = search.place();
  if (place.visit == k_no_place) return std::nullopt;
  const Visit& at = search.visit(place.visit);
  WideTree joined;
  Bvh& bvh = joined.bvh;
  bvh.nodes.reserve(tree.bvh.nodes.size() + inserted.bvh.nodes.size() + k_node_floats);
  bvh.leaves.reserve(tree.bvh.leaves.size() + inserted.bvh.leaves.size());
  bvh = tree.bvh;
  const Offsets offsets = append(inserted.bvh, place.unfolded, first, bvh);
  if (place.beside) {
    const auto fresh = static_cast<std::uint32_t>(bvh.nodes.size() / k_node_floats);
    bvh.nodes.resize(bvh.nodes.size() + k_node_floats, 0.0f);
    float* node = node_at(bvh, fresh);
    constexpr float k_far = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < k_slots; ++i)
      set_child(node, i, {{k_far, k_far, k_far}, {-k_far, -k_far, -k_far}}, 0);
    float* parent = node_at(bvh, at.node);
    const NodeBox other = child_box(parent, *place.beside);
    set_child(node, 0, other, child_reference(parent, *place.beside));
    add_guest(inserted.bvh, place.unfolded, offsets, node);
    set_child(parent, *place.beside, around(other, search.box()), fresh);
  } else {
    add_guest(inserted.bvh, place.unfolded, offsets, node_at(bvh, at.node));
  }
  for (const Visit* visit = &at; visit->parent != k_no_place;
       visit = &search.visit(visit->parent)) {
    float* parent = node_at(bvh, search.visit(visit->parent).node);
    set_child(parent, visit->slot, around(child_box(parent, visit->slot), search.box()),
              visit->node);
  }
  set_root_box(bvh, around(root_box(tree.bvh), search.box()));
  const unsigned above = at.depth + (place.beside ? 1U : 0U);
  joined.levels = std::max(tree.levels + (place.beside ? 1U : 0U), above + inserted.levels);
  return joined;
}

}  // namespace ds

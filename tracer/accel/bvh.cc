// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/bvh.h"

#include "tracer/accel/binary_tree.h"
#include "tracer/accel/tree_cache.h"
#include "tracer/accel/tree_join.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace ds {
namespace {

using namespace kernels;

using Corners = std::array<Vec3, 3>;
constexpr std::size_t k_width = k_bvh_width;
static_assert(k_most_bvh_width == k_bvh_width);

/// Costs of visiting a node and a leaf of up to eight triangles, in one unit: the kernels' steps
/// for them take 105 and about 130 instructions.
constexpr float k_node_cost = 1.0f;
constexpr float k_leaf_cost = 1.2f;

/// Which binary nodes become the children of which wide node, so that the tree costs random rays
/// the least: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", section 3.1, with leaves of up to eight triangles at one price.
class Collapse {
 public:
  Collapse(std::span<const BinaryNode> tree, std::size_t width)
      : tree_(tree), width_(width), choices_(tree.size()) {
    for (std::size_t i = 0; i < tree.size(); ++i)
      decide(i);
  }

  bool is_leaf(std::uint32_t node) const { return choices_[node].is_leaf; }

  /// Children of the wide node made of inner node `node`: two to `width`.
  std::vector<std::uint32_t> children(std::uint32_t node) const {
    std::vector<std::uint32_t> found;
    const std::size_t left = choices_[node].left_share[width_];
    collect(tree_[node].left, left, found);
    collect(tree_[node].right, width_ - left, found);
    return found;
  }

 private:
  struct Choice {
    /// Least cost of standing below a wide node as at most `i` of its children.
    std::array<float, k_width + 1> cost{};
    /// How many of `i` children the left side gets; 0: one child less is as good.
    std::array<std::uint8_t, k_width + 1> left_share{};
    bool is_leaf = false;
  };

  void decide(std::size_t i) {
    const BinaryNode& node = tree_[i];
    Choice& choice = choices_[i];
    const float area = node.bounds.half_area();
    const float as_leaf =
        node.leaf_count <= k_width ? area * k_leaf_cost : std::numeric_limits<float>::infinity();
    if (node.leaf_count == 1) {
      choice.is_leaf = true;
      choice.cost.fill(as_leaf);
      return;
    }
    const float as_node = split(node, width_, choice.left_share[width_]) + area * k_node_cost;
    choice.is_leaf = as_leaf <= as_node;
    choice.cost[1] = std::min(as_leaf, as_node);
    for (std::size_t count = 2; count < width_; ++count) {
      std::uint8_t left = 0;
      const float cost = split(node, count, left);
      const bool better = cost < choice.cost[count - 1];
      choice.cost[count] = better ? cost : choice.cost[count - 1];
      choice.left_share[count] = better ? left : std::uint8_t{0};
    }
  }

  /// Least cost of dividing `count` children between the two sides.
  float split(const BinaryNode& node, std::size_t count, std::uint8_t& left) const {
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 1; i < count; ++i) {
      const float cost = choices_[node.left].cost[i] + choices_[node.right].cost[count - i];
      if (cost < least || i == 1) {
        least = cost;
        left = static_cast<std::uint8_t>(i);
      }
    }
    return least;
  }

  void collect(std::uint32_t node, std::size_t count, std::vector<std::uint32_t>& found) const {
    const Choice& choice = choices_[node];
    while (count > 1 && choice.left_share[count] == 0)
      --count;
    if (count == 1 || choice.is_leaf) {
      found.push_back(node);
      return;
    }
    const std::size_t left = choice.left_share[count];
    collect(tree_[node].left, left, found);
    collect(tree_[node].right, count - left, found);
  }

  std::span<const BinaryNode> tree_;
  std::size_t width_;
  std::vector<Choice> choices_;
};

/// Writes the wide tree in the kernels' layout, depth first.
class Flattener {
 public:
  Flattener(std::span<const BinaryNode> tree, std::span<const Corners> triangles, std::size_t width)
      : tree_(tree), triangles_(triangles), collapse_(tree, width) {}

  WideTree run() {
    const auto root = static_cast<std::uint32_t>(tree_.size() - 1);
    levels_ = 1;
    if (collapse_.is_leaf(root)) {
      // The kernels start at a node, so a scene of a few triangles gets one above its leaf.
      const std::size_t at = append_node();
      set_child(at, 0, tree_[root].bounds, write_leaf(root));
    } else {
      write_node(root, 1);
    }
    const NodeBox& bounds = tree_[root].bounds;
    std::copy(bounds.low.begin(), bounds.low.end(), bvh_.nodes.begin() + k_root_bounds * k_width);
    std::copy(bounds.high.begin(), bounds.high.end(),
              bvh_.nodes.begin() + k_root_bounds * k_width + 3);
    return {std::move(bvh_), levels_};
  }

 private:
  static constexpr std::size_t k_node_floats = k_node_vectors * k_width;
  static constexpr std::size_t k_leaf_floats = k_leaf_vectors * k_width;

  std::uint32_t write_node(std::uint32_t node, unsigned depth) {
    if (depth > k_bvh_depth)
      fail(ErrorKind::device, "the scene's tree has more than {} levels", unsigned{k_bvh_depth});
    levels_ = std::max(levels_, depth);
    const std::size_t at = append_node();
    const std::vector<std::uint32_t> children = collapse_.children(node);
    for (std::size_t i = 0; i < children.size(); ++i) {
      // The calls may move bvh_.nodes, so the child is written first and its place looked up after.
      const std::uint32_t reference = collapse_.is_leaf(children[i])
                                          ? write_leaf(children[i])
                                          : write_node(children[i], depth + 1);
      set_child(at, i, tree_[children[i]].bounds, reference);
    }
    return static_cast<std::uint32_t>(at / k_node_floats);
  }

  std::size_t append_node() {
    const std::size_t at = bvh_.nodes.size();
    bvh_.nodes.resize(at + k_node_floats, 0.0f);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (std::size_t vector = 0; vector < 6; ++vector)
      for (std::size_t i = 0; i < k_width; ++i)
        bvh_.nodes[at + vector * k_width + i] = vector % 2 == 0 ? infinity : -infinity;
    return at;
  }

  void set_child(std::size_t at, std::size_t i, const NodeBox& b, std::uint32_t reference) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bvh_.nodes[at + 2 * axis * k_width + i] = b.low[axis];
      bvh_.nodes[at + (2 * axis + 1) * k_width + i] = b.high[axis];
    }
    bvh_.nodes[at + k_node_children * k_width + i] = std::bit_cast<float>(reference);
  }

  void collect_triangles(std::uint32_t node, std::vector<std::uint32_t>& found) const {
    const BinaryNode& n = tree_[node];
    if (n.leaf_count == 1) {
      found.push_back(n.triangle);
      return;
    }
    collect_triangles(n.left, found);
    collect_triangles(n.right, found);
  }

  std::uint32_t write_leaf(std::uint32_t node) {
    std::vector<std::uint32_t> ids;
    collect_triangles(node, ids);
    // Ascending: within a leaf, the first of equally near triangles is the one of least id. A split
    // triangle's pieces may meet again here.
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const std::size_t at = bvh_.leaves.size();
    bvh_.leaves.resize(at + k_leaf_floats, 0.0f);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Corners& corners = triangles_[ids[i]];
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
          bvh_.leaves[at + (3 * corner + axis) * k_width + i] =
              corners[corner][static_cast<int>(axis)];
      bvh_.leaves[at + k_leaf_ids * k_width + i] = std::bit_cast<float>(ids[i]);
    }
    return 0x80000000u | static_cast<std::uint32_t>(at / k_leaf_floats);
  }

  std::span<const BinaryNode> tree_;
  std::span<const Corners> triangles_;
  Collapse collapse_;
  Bvh bvh_;
  unsigned levels_ = 0;
};

}  // namespace

Bvh build_bvh(std::span<const Corners> triangles, BvhQuality quality, int width) {
  return build_wide_tree(triangles, quality, width).bvh;
}

WideTree build_wide_tree(std::span<const Corners> triangles, BvhQuality quality, int width) {
  DS_ASSERT(width >= k_least_bvh_width && width <= k_most_bvh_width);
  const std::vector<BinaryNode> tree = build_binary_tree(triangles, quality);
  return Flattener(tree, triangles, static_cast<std::size_t>(width)).run();
}

Bvh build_joined_bvh(std::span<const Corners> triangles, std::size_t first_count,
                     BvhQuality quality, int width, TreeCache& cache) {
  DS_ASSERT(first_count <= triangles.size());
  if (first_count == 0 || first_count == triangles.size())
    return cache.get(triangles, quality, width)->bvh;
  const auto first = cache.get(triangles.first(first_count), quality, width);
  const auto second = cache.get(triangles.subspan(first_count), quality, width);
  auto joined = join_trees(*first, *second, static_cast<std::uint32_t>(first_count), width);
  return joined ? std::move(joined->bvh) : build_bvh(triangles, quality, width);
}

}  // namespace ds

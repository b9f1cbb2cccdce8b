// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/bvh.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace ds {
namespace {

using namespace kernels;

using Corners = std::array<Vec3, 3>;
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// What Embree's builder makes: an inner node of up to eight children, or a leaf of up to eight
/// triangles.
struct BuildNode {
  bool is_leaf = false;
  unsigned count = 0;
  std::array<BuildNode*, k_bvh_width> child{};
  std::array<RTCBounds, k_bvh_width> bounds{};
  std::array<unsigned, k_bvh_width> triangle{};
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
  node->count = count;
  return node;
}

void set_children(void* pointer, void** children, unsigned count, void*) {
  auto* node = static_cast<BuildNode*>(pointer);
  for (unsigned i = 0; i < count; ++i)
    node->child[i] = static_cast<BuildNode*>(children[i]);
}

void set_bounds(void* pointer, const RTCBounds** bounds, unsigned count, void*) {
  auto* node = static_cast<BuildNode*>(pointer);
  for (unsigned i = 0; i < count; ++i)
    node->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t count, void*) {
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
  node->is_leaf = true;
  node->count = static_cast<unsigned>(count);
  for (std::size_t i = 0; i < count; ++i)
    node->triangle[i] = primitives[i].primID;
  // Ascending ids: within a leaf, the first of equally near triangles is the one of least id.
  std::sort(node->triangle.begin(), node->triangle.begin() + static_cast<std::ptrdiff_t>(count));
  return node;
}

/// Bounds of a triangle, moved outwards by the triangle test's error over the triangle's own extent
/// (kernels/bvh.cl).
RTCBuildPrimitive primitive_of(const Corners& c, unsigned id) {
  constexpr float box_error = 4.76837158203125e-7f;
  RTCBuildPrimitive p{};
  p.lower_x = std::min({c[0].x, c[1].x, c[2].x});
  p.lower_y = std::min({c[0].y, c[1].y, c[2].y});
  p.lower_z = std::min({c[0].z, c[1].z, c[2].z});
  p.upper_x = std::max({c[0].x, c[1].x, c[2].x});
  p.upper_y = std::max({c[0].y, c[1].y, c[2].y});
  p.upper_z = std::max({c[0].z, c[1].z, c[2].z});
  const float margin =
      box_error * std::max({p.upper_x - p.lower_x, p.upper_y - p.lower_y, p.upper_z - p.lower_z});
  for (float* lower : {&p.lower_x, &p.lower_y, &p.lower_z})
    *lower -= margin;
  for (float* upper : {&p.upper_x, &p.upper_y, &p.upper_z})
    *upper += margin;
  p.primID = id;
  return p;
}

float& axis_of(float& x, unsigned axis) {
  return *(&x + axis);
}

/// Shrinks `bounds` to the part of the triangle on one side of a plane.
void clip_bounds(const Corners& c, unsigned axis, float position, bool lower_side,
                 RTCBounds& bounds) {
  std::array<float, 3> low = {k_infinity, k_infinity, k_infinity};
  std::array<float, 3> high = {-k_infinity, -k_infinity, -k_infinity};
  const auto include = [&](Vec3 p) {
    for (int i = 0; i < 3; ++i) {
      low[static_cast<std::size_t>(i)] = std::min(low[static_cast<std::size_t>(i)], p[i]);
      high[static_cast<std::size_t>(i)] = std::max(high[static_cast<std::size_t>(i)], p[i]);
    }
  };
  const int a = static_cast<int>(axis);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 from = c[i];
    const Vec3 to = c[(i + 1) % 3];
    if (lower_side ? from[a] <= position : from[a] >= position) include(from);
    if ((from[a] < position) != (to[a] < position) && from[a] != to[a])
      include(from + (to - from) * ((position - from[a]) / (to[a] - from[a])));
  }
  for (unsigned i = 0; i < 3; ++i) {
    float& lower = axis_of(bounds.lower_x, i);
    float& upper = axis_of(bounds.upper_x, i);
    lower = std::max(lower, low[i]);
    upper = std::min(upper, high[i]);
  }
}

void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position,
                     RTCBounds* left, RTCBounds* right, void* user) {
  const auto& triangles = *static_cast<const std::span<const Corners>*>(user);
  for (RTCBounds* side : {left, right}) {
    side->lower_x = primitive->lower_x;
    side->lower_y = primitive->lower_y;
    side->lower_z = primitive->lower_z;
    side->upper_x = primitive->upper_x;
    side->upper_y = primitive->upper_y;
    side->upper_z = primitive->upper_z;
    side->align0 = side->align1 = 0;
  }
  axis_of(left->upper_x, axis) = position;
  axis_of(right->lower_x, axis) = position;
  clip_bounds(triangles[primitive->primID], axis, position, true, *left);
  clip_bounds(triangles[primitive->primID], axis, position, false, *right);
}

RTCBuildQuality embree_quality(BvhQuality quality) {
  switch (quality) {
    case BvhQuality::low:
      return RTC_BUILD_QUALITY_LOW;
    case BvhQuality::medium:
      return RTC_BUILD_QUALITY_MEDIUM;
    case BvhQuality::high:
      break;
  }
  return RTC_BUILD_QUALITY_HIGH;
}

/// Embree's device and the memory of one build.
class Builder {
 public:
  Builder() : device_(rtcNewDevice("")) {
    if (device_ == nullptr) fail(ErrorKind::device, "embree: no device can be made");
    bvh_ = rtcNewBVH(device_);
    if (bvh_ == nullptr) fail_embree();
  }
  ~Builder() {
    rtcReleaseBVH(bvh_);
    rtcReleaseDevice(device_);
  }
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  const BuildNode& build(std::span<const Corners> triangles,
                         std::vector<RTCBuildPrimitive>& primitives, BvhQuality quality) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = embree_quality(quality);
    arguments.maxBranchingFactor = k_bvh_width;
    arguments.sahBlockSize = k_bvh_width;
    arguments.maxDepth = 32;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = k_bvh_width;
    arguments.traversalCost = 1.0f;
    arguments.intersectionCost = 1.0f;
    arguments.bvh = bvh_;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.capacity();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = split_primitive;
    arguments.userPtr = &triangles;
    const auto* root = static_cast<const BuildNode*>(rtcBuildBVH(&arguments));
    if (root == nullptr) fail_embree();
    return *root;
  }

 private:
  [[noreturn]] void fail_embree() const {
    fail(ErrorKind::device, "embree: building the tree failed with error {}",
         static_cast<int>(rtcGetDeviceError(device_)));
  }
  RTCDevice device_;
  RTCBVH bvh_ = nullptr;
};

/// Writes Embree's nodes in the kernels' layout, depth first.
class Flattener {
 public:
  explicit Flattener(std::span<const Corners> triangles) : triangles_(triangles) {}

  Bvh run(const BuildNode& root) {
    if (root.is_leaf) {
      write_single_leaf_root(root);
    } else {
      write(root);
    }
    return std::move(bvh_);
  }

 private:
  static constexpr std::size_t k_node_floats = k_node_vectors * k_bvh_width;
  static constexpr std::size_t k_leaf_floats = k_leaf_vectors * k_bvh_width;

  std::uint32_t write(const BuildNode& node) {
    if (node.is_leaf) return write_leaf(node);
    const std::size_t at = append_node();
    for (std::size_t i = 0; i < node.count; ++i) {
      // The call may move bvh_.nodes, so the child is written first and its place looked up after.
      const std::uint32_t reference = write(*node.child[i]);
      set_child(at, i, node.bounds[i], reference);
    }
    return static_cast<std::uint32_t>(at / k_node_floats);
  }

  /// The kernels start at a node, so a scene of one leaf gets one above it.
  void write_single_leaf_root(const BuildNode& leaf) {
    RTCBounds all = {};
    all.lower_x = all.lower_y = all.lower_z = std::numeric_limits<float>::infinity();
    all.upper_x = all.upper_y = all.upper_z = -std::numeric_limits<float>::infinity();
    for (unsigned i = 0; i < leaf.count; ++i) {
      const RTCBuildPrimitive p = primitive_of(triangles_[leaf.triangle[i]], 0);
      all.lower_x = std::min(all.lower_x, p.lower_x);
      all.lower_y = std::min(all.lower_y, p.lower_y);
      all.lower_z = std::min(all.lower_z, p.lower_z);
      all.upper_x = std::max(all.upper_x, p.upper_x);
      all.upper_y = std::max(all.upper_y, p.upper_y);
      all.upper_z = std::max(all.upper_z, p.upper_z);
    }
    const std::size_t at = append_node();
    set_child(at, 0, all, write_leaf(leaf));
  }

  std::size_t append_node() {
    const std::size_t at = bvh_.nodes.size();
    bvh_.nodes.resize(at + k_node_floats, 0.0f);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (std::size_t vector = 0; vector < 6; ++vector)
      for (std::size_t i = 0; i < k_bvh_width; ++i)
        bvh_.nodes[at + vector * k_bvh_width + i] = vector % 2 == 0 ? infinity : -infinity;
    return at;
  }

  void set_child(std::size_t at, std::size_t i, const RTCBounds& b, std::uint32_t reference) {
    const std::array<float, 6> planes = {b.lower_x, b.upper_x, b.lower_y,
                                         b.upper_y, b.lower_z, b.upper_z};
    for (std::size_t vector = 0; vector < 6; ++vector)
      bvh_.nodes[at + vector * k_bvh_width + i] = planes[vector];
    bvh_.nodes[at + k_node_children * k_bvh_width + i] = std::bit_cast<float>(reference);
  }

  std::uint32_t write_leaf(const BuildNode& node) {
    const std::size_t at = bvh_.leaves.size();
    bvh_.leaves.resize(at + k_leaf_floats, 0.0f);
    for (std::size_t i = 0; i < node.count; ++i) {
      const Corners& corners = triangles_[node.triangle[i]];
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
          bvh_.leaves[at + (3 * corner + axis) * k_bvh_width + i] =
              corners[corner][static_cast<int>(axis)];
      bvh_.leaves[at + k_leaf_ids * k_bvh_width + i] =
          std::bit_cast<float>(std::uint32_t{node.triangle[i]});
    }
    return 0x80000000u | static_cast<std::uint32_t>(at / k_leaf_floats);
  }

  std::span<const Corners> triangles_;
  Bvh bvh_;
};

/// Entries a ray may have waiting at once below this node: all but one child of every node on the
/// way down.
unsigned stack_need(const BuildNode& node) {
  if (node.is_leaf) return 0;
  unsigned deepest = 0;
  for (unsigned i = 0; i < node.count; ++i)
    deepest = std::max(deepest, stack_need(*node.child[i]));
  return deepest + node.count;
}

}  // namespace

Bvh build_bvh(std::span<const Corners> triangles, BvhQuality quality) {
  DS_ASSERT(!triangles.empty());
  std::vector<RTCBuildPrimitive> primitives;
  // Room for the pieces of split triangles.
  primitives.reserve(triangles.size() * 2);
  std::array<float, 6> bounds = {k_infinity,  k_infinity,  k_infinity,
                                 -k_infinity, -k_infinity, -k_infinity};
  for (const Corners& c : triangles) {
    primitives.push_back(primitive_of(c, static_cast<unsigned>(primitives.size())));
    const RTCBuildPrimitive& p = primitives.back();
    bounds = {std::min(bounds[0], p.lower_x), std::min(bounds[1], p.lower_y),
              std::min(bounds[2], p.lower_z), std::max(bounds[3], p.upper_x),
              std::max(bounds[4], p.upper_y), std::max(bounds[5], p.upper_z)};
  }
  Builder builder;
  const BuildNode& root = builder.build(triangles, primitives, quality);
  const unsigned need = stack_need(root);
  if (need > k_bvh_stack)
    fail(ErrorKind::device, "the scene's tree needs a stack of {} entries, the tracer has {}", need,
         unsigned{k_bvh_stack});
  Bvh bvh = Flattener(triangles).run(root);
  std::copy(bounds.begin(), bounds.end(), bvh.nodes.begin() + k_root_bounds * k_bvh_width);
  return bvh;
}

}  // namespace ds

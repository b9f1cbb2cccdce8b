// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/binary_tree.h"

#include "tracer/base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// What Embree's builder makes: an inner node of two children, or a leaf of one triangle.
struct BuildNode {
  bool is_leaf = false;
  unsigned triangle = 0;
  std::array<BuildNode*, 2> child{};
  std::array<RTCBounds, 2> bounds{};
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
}

void set_children(void* pointer, void** children, unsigned count, void*) {
  DS_ASSERT(count == 2);
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
  DS_ASSERT(count == 1);
  auto* node = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
  node->is_leaf = true;
  node->triangle = primitives[0].primID;
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

/// Beyond any tree that splitting by cost makes of real meshes; deeper ones Embree refuses.
constexpr unsigned k_most_levels = 128;

/// One for all builds and threads, and to the end of the process: making it takes as long as a
/// small tree.
RTCDevice shared_device() {
  static RTCDeviceTy* const device = rtcNewDevice("");
  if (device == nullptr) fail(ErrorKind::device, "embree: no device can be made");
  return device;
}

/// The memory of one build.
class Builder {
 public:
  Builder() : device_(shared_device()), bvh_(rtcNewBVH(device_)) {
    if (bvh_ == nullptr) fail_embree();
  }
  ~Builder() { rtcReleaseBVH(bvh_); }
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  const BuildNode& build(std::span<const Corners> triangles,
                         std::vector<RTCBuildPrimitive>& primitives, BvhQuality quality) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = embree_quality(quality);
    arguments.maxBranchingFactor = 2;
    arguments.sahBlockSize = 1;
    arguments.maxDepth = k_most_levels;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
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
  RTCBVH bvh_;
};

NodeBox box_of(const RTCBounds& b) {
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

/// Writes the node and what is below; returns its place.
std::uint32_t append(const BuildNode& node, const NodeBox& bounds, std::vector<BinaryNode>& tree) {
  BinaryNode entry{.bounds = bounds};
  if (node.is_leaf) {
    entry.triangle = node.triangle;
    entry.left = entry.right = static_cast<std::uint32_t>(tree.size());
  } else {
    entry.left = append(*node.child[0], box_of(node.bounds[0]), tree);
    entry.right = append(*node.child[1], box_of(node.bounds[1]), tree);
    entry.leaf_count = tree[entry.left].leaf_count + tree[entry.right].leaf_count;
  }
  tree.push_back(entry);
  return static_cast<std::uint32_t>(tree.size() - 1);
}

}  // namespace

std::vector<BinaryNode> build_binary_tree(std::span<const Corners> triangles, BvhQuality quality) {
  DS_ASSERT(!triangles.empty());
  std::vector<RTCBuildPrimitive> primitives;
  // Room for the pieces of split triangles.
  primitives.reserve(triangles.size() * 2);
  NodeBox bounds = {{k_infinity, k_infinity, k_infinity}, {-k_infinity, -k_infinity, -k_infinity}};
  for (const Corners& c : triangles) {
    primitives.push_back(primitive_of(c, static_cast<unsigned>(primitives.size())));
    const RTCBuildPrimitive& p = primitives.back();
    bounds = {{std::min(bounds.low[0], p.lower_x), std::min(bounds.low[1], p.lower_y),
               std::min(bounds.low[2], p.lower_z)},
              {std::max(bounds.high[0], p.upper_x), std::max(bounds.high[1], p.upper_y),
               std::max(bounds.high[2], p.upper_z)}};
  }
  Builder builder;
  std::vector<BinaryNode> tree;
  tree.reserve(triangles.size() * 2);
  append(builder.build(triangles, primitives, quality), bounds, tree);
  return tree;
}

}  // namespace ds

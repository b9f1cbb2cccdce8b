// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/device/opencl.h"
#include "tracer/scene/mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Rays on the device against a tree, for tests of what they hit.
namespace ds::rays {

using Corners = std::array<Vec3, 3>;

/// A mesh's triangles by their corners, in its order.
std::vector<Corners> corners_of(const Mesh& mesh);

struct TestRay {
  Vec3 origin, direction;
  float t_max = 1e30f;
};

struct TestHit {
  float t = 0, b1 = 0, b2 = 0;
  std::uint32_t id = 0xffffffffu;
  bool operator==(const TestHit&) const = default;
  bool met() const { return id != 0xffffffffu; }
};

/// The tracer's nearest and any hit on the first CPU device.
class Tree {
 public:
  explicit Tree(std::span<const Corners> triangles, BvhQuality quality = BvhQuality::medium,
                int width = k_most_bvh_width);
  explicit Tree(const Bvh& bvh);
  std::vector<TestHit> nearest(std::span<const TestRay> rays) const;
  std::vector<std::uint32_t> any(std::span<const TestRay> rays) const;

  /// The same rays as the path tracer asks, `lanes` of them side by side (weights are left 0).
  struct Batched {
    std::vector<TestHit> nearest;
    std::vector<std::uint32_t> any;
  };
  Batched batched(std::span<const TestRay> rays, int lanes) const;

 private:
  Buffer upload_rays(std::span<const TestRay> rays, std::size_t padded) const;
  Device device_;
  Program program_;
  Buffer nodes_, leaves_;
};

}  // namespace ds::rays

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/base/hash.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>

namespace ds {

/// Trees that were built before, by the triangles they are of: an environment's is the same for
/// each model in it, and a model's in each environment. Safe from several threads.
class TreeCache {
 public:
  explicit TreeCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// As build_wide_tree.
  std::shared_ptr<const WideTree> get(std::span<const std::array<Vec3, 3>> triangles,
                                      BvhQuality quality, int width = k_most_bvh_width);
  /// How many were built.
  std::uint64_t built() const;

 private:
  struct Known {
    Hash128 triangles;
    BvhQuality quality;
    int width;
    std::shared_ptr<const WideTree> tree;
  };

  mutable std::mutex mutex_;
  std::size_t most_bytes_, bytes_ = 0;
  std::uint64_t built_ = 0;
  std::list<Known> known_;  ///< the last used first
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/tree_cache.h"

#include <algorithm>

namespace ds {

std::shared_ptr<const WideTree> TreeCache::get(std::span<const std::array<Vec3, 3>> triangles,
                                               BvhQuality quality, int width) {
  const Hash128 hash = hash_bytes(std::as_bytes(triangles));
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.triangles == hash && known.quality == quality && known.width == width;
  });
  if (found != known_.end()) {
    known_.splice(known_.begin(), known_, found);
    return known_.front().tree;
  }
  auto tree = std::make_shared<const WideTree>(build_wide_tree(triangles, quality, width));
  ++built_;
  const auto bytes_of = [](const WideTree& of) {
    return (of.bvh.nodes.size() + of.bvh.leaves.size()) * sizeof(float);
  };
  if (bytes_of(*tree) > most_bytes_) return tree;
  known_.push_front({hash, quality, width, tree});
  for (bytes_ += bytes_of(*tree); bytes_ > most_bytes_; known_.pop_back())
    bytes_ -= bytes_of(*known_.back().tree);
  return tree;
}

std::uint64_t TreeCache::built() const {
  const std::lock_guard lock(mutex_);
  return built_;
}

}  // namespace ds

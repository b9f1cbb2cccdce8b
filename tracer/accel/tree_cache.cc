// SPDX-License-Identifier: Apache-2.0
#include "tracer/accel/tree_cache.h"

#include "tracer/accel/binary_tree.h"

#include <algorithm>

namespace ds {

std::shared_ptr<const std::vector<BinaryNode>> TreeCache::get(
    std::span<const std::array<Vec3, 3>> triangles, BvhQuality quality) {
  const Hash128 hash = hash_bytes(std::as_bytes(triangles));
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
    return known.triangles == hash && known.quality == quality;
  });
  if (found != known_.end()) {
    known_.splice(known_.begin(), known_, found);
    return known_.front().tree;
  }
  auto tree =
      std::make_shared<const std::vector<BinaryNode>>(build_binary_tree(triangles, quality));
  ++built_;
  const auto bytes_of = [](const Tree& of) { return of->size() * sizeof(BinaryNode); };
  if (bytes_of(tree) > most_bytes_) return tree;
  known_.push_front({hash, quality, tree});
  for (bytes_ += bytes_of(tree); bytes_ > most_bytes_; known_.pop_back())
    bytes_ -= bytes_of(known_.back().tree);
  return tree;
}

std::uint64_t TreeCache::built() const {
  const std::lock_guard lock(mutex_);
  return built_;
}

}  // namespace ds

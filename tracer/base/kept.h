// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <algorithm>
#include <cstddef>
#include <list>
#include <memory>
#include <utility>

namespace ds {

/// Values that were made before, by a hash of all that they depend on. Those used last are kept, up
/// to a number of bytes. Called from one thread at a time.
template <typename T>
class Kept {
 public:
  explicit Kept(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// The value, made where it is not known. `bytes_held(value)` tells its size.
  template <typename Make>
  std::shared_ptr<const T> get(Hash128 key, const Make& make) {
    const auto found = std::find_if(known_.begin(), known_.end(),
                                    [&](const auto& known) { return known.first == key; });
    if (found != known_.end()) {
      known_.splice(known_.begin(), known_, found);
      return known_.front().second;
    }
    auto value = std::make_shared<const T>(make());
    if (bytes_held(*value) > most_bytes_) return value;
    known_.emplace_front(key, value);
    for (bytes_ += bytes_held(*value); bytes_ > most_bytes_; known_.pop_back())
      bytes_ -= bytes_held(*known_.back().second);
    return value;
  }

 private:
  std::size_t most_bytes_, bytes_ = 0;
  std::list<std::pair<Hash128, std::shared_ptr<const T>>> known_;  ///< last used first
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>
#include <vector>

namespace ds {

/// A box, metres.
struct Box3 {
  Vec3d low, high;
};
/// Whether they have a point in common.
bool meet(const Box3& a, const Box3& b);

/// A box in floats, as kernels have it; metres.
struct TiePlace {
  std::array<float, 3> low, high;
  friend bool operator==(const TiePlace&, const TiePlace&) = default;
};

/// Few boxes that together hold many: each new one is put together with those it meets, and where there
/// are more than k_most_tie_places of them, the two whose common box has the least surface above their
/// own become one.
class TiePlaces {
 public:
  /// low <= high in every axis.
  void add(const Box3& added);
  /// Rounded outwards to floats.
  std::vector<TiePlace> take() const;

 private:
  void join_nearest();

  std::vector<Box3> boxes_;
};

}  // namespace ds

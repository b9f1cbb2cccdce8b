// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"

#include <array>
#include <vector>

namespace ds {

/// A box, metres.
struct TiePlace {
  std::array<float, 3> low, high;
  friend bool operator==(const TiePlace&, const TiePlace&) = default;
};

/// Few boxes that together hold many: each new one is put together with those it meets, and where there
/// are more than k_most_tie_places of them, the two whose common box has the least surface above their
/// own become one.
class TiePlaces {
 public:
  /// low <= high in every axis; metres.
  void add(Vec3d low, Vec3d high);
  /// Rounded outwards to floats.
  std::vector<TiePlace> take() const;

 private:
  struct Box {
    Vec3d low, high;
  };
  static Box both(const Box& a, const Box& b);
  static bool meet(const Box& a, const Box& b);
  static double half_surface(const Box& box);
  void join_nearest();

  std::vector<Box> boxes_;
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/scene/mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

using Triangle = std::array<std::uint32_t, 3>;

/// For each key the index of the first key equal to it (its own where it is the first). The result
/// does not depend on the hash. At most 2^31 keys.
template <std::size_t n>
std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, n>> keys);

/// For each position the index of the first one at the same place (-0 equals 0, and a NaN its own
/// bits).
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions);

/// The same for positions that fall into one cell of a grid of 2^-20 of the mesh's longest side:
/// places that a program computed twice, as the two ends of a turn are, differ in their last digits.
std::vector<std::uint32_t> weld_seams(std::span<const Vec3d> positions);

/// Half-edge 3 t + k runs from corner k to corner (k + 1) % 3 of triangle t. Groups them by the
/// edge they lie on, whichever way they run; `at` maps a vertex index to the vertex it counts as.
struct EdgeGroups {
  std::vector<std::uint32_t> half_edges;  ///< group after group; ascending within each
  std::vector<std::uint32_t> ends;        ///< where each group ends

  template <typename Visit>
  void for_each(Visit visit) const {
    std::size_t begin = 0;
    for (const std::uint32_t end : ends) {
      visit(std::span(half_edges).subspan(begin, end - begin));
      begin = end;
    }
  }
};
EdgeGroups group_edges(std::span<const Triangle> triangles, std::span<const std::uint32_t> at);

inline std::uint32_t next_half_edge(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}

/// The vertex a half-edge starts at, which is also the corner of that number.
inline std::uint32_t start_of(std::span<const Triangle> triangles,
                              std::span<const std::uint32_t> at, std::uint32_t h) {
  return at[triangles[h / 3][h % 3]];
}

/// Disjoint sets of 0 ... size - 1, each element with a side (0 or 1) relative to its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size);
  struct Found {
    std::uint32_t root;
    std::uint32_t side;
  };
  Found find(std::uint32_t element);
  /// Makes one set of two, with a and b on the same side (`turned` false) or on two. Leaves
  /// elements that are in one set already as they are. The lesser root stays.
  void join(std::uint32_t a, std::uint32_t b, bool turned = false);

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> side_;  ///< relative to the parent
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_topology.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace ds {
namespace {

constexpr std::uint32_t k_none = 0xffffffffU;

template <std::size_t n>
std::uint64_t mix(const std::array<std::uint32_t, n>& key) {
  std::uint64_t h = n;
  for (const std::uint32_t word : key) {
    // The finaliser of SplitMix64 (Steele, Lea, Flood 2014), one round a word.
    h = (h ^ word) * 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 31U;
  }
  return h * 0x94d049bb133111ebULL;
}

}  // namespace

template <std::size_t n>
std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, n>> keys) {
  DS_ASSERT(keys.size() <= (std::size_t{1} << 31U));
  const std::size_t slots = std::bit_ceil(2 * keys.size() + 1);
  const int shift = 64 - std::countr_zero(slots);
  std::vector<std::uint32_t> table(slots, k_none);
  std::vector<std::uint32_t> first(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    std::size_t slot = slots == 1 ? 0 : static_cast<std::size_t>(mix(keys[i]) >> shift);
    while (table[slot] != k_none && keys[table[slot]] != keys[i])
      slot = (slot + 1) & (slots - 1);
    if (table[slot] == k_none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}
template std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, 3>>);
template std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, 4>>);
template std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, 5>>);
template std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, 6>>);
template std::vector<std::uint32_t> first_equal(std::span<const std::array<std::uint32_t, 7>>);

std::vector<std::uint32_t> weld(std::span<const Vec3d> positions) {
  std::vector<std::array<std::uint32_t, 6>> keys;
  keys.reserve(positions.size());
  for (const Vec3d p : positions)
    keys.push_back(std::bit_cast<std::array<std::uint32_t, 6>>(p + Vec3d{0, 0, 0}));  // -0 -> 0
  return first_equal<6>(keys);
}

std::vector<std::uint32_t> weld_seams(std::span<const Vec3d> positions) {
  constexpr double k_cells = 0x1p20;
  Vec3d low = positions.empty() ? Vec3d{} : positions[0], high = low;
  for (const Vec3d p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  const double scale = longest > 0 ? k_cells / longest : 0;
  const auto cell = [&](double from_low) {
    return static_cast<std::uint32_t>(std::lround(from_low * scale));
  };
  std::vector<std::array<std::uint32_t, 3>> keys;
  keys.reserve(positions.size());
  for (const Vec3d p : positions)
    keys.push_back({cell(p.x - low.x), cell(p.y - low.y), cell(p.z - low.z)});
  return first_equal<3>(keys);
}

EdgeGroups group_edges(std::span<const Triangle> triangles, std::span<const std::uint32_t> at) {
  const auto count = static_cast<std::uint32_t>(3 * triangles.size());
  const auto ends_of = [&](std::uint32_t h) -> std::pair<std::uint32_t, std::uint32_t> {
    const std::uint32_t from = start_of(triangles, at, h);
    const std::uint32_t to = start_of(triangles, at, next_half_edge(h));
    return {std::min(from, to), std::max(from, to)};
  };
  // Counting sort by the lesser end, then each short run by the greater one.
  std::vector<std::uint32_t> starts(at.size() + 1, 0);
  for (std::uint32_t h = 0; h < count; ++h)
    ++starts[ends_of(h).first + 1];
  for (std::size_t i = 1; i < starts.size(); ++i)
    starts[i] += starts[i - 1];
  struct Entry {
    std::uint32_t other_end;
    std::uint32_t half_edge;
    bool operator<(const Entry& o) const {
      return other_end != o.other_end ? other_end < o.other_end : half_edge < o.half_edge;
    }
  };
  std::vector<Entry> entries(count);
  std::vector<std::uint32_t> fill(starts.begin(), starts.end() - 1);
  for (std::uint32_t h = 0; h < count; ++h) {
    const auto [lesser, greater] = ends_of(h);
    entries[fill[lesser]++] = {greater, h};
  }

  EdgeGroups groups;
  groups.half_edges.reserve(count);
  groups.ends.reserve(count / 2);
  for (std::size_t v = 0; v + 1 < starts.size(); ++v) {
    const auto run = std::span(entries).subspan(starts[v], starts[v + 1] - starts[v]);
    std::sort(run.begin(), run.end());
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (i > 0 && run[i].other_end != run[i - 1].other_end)
        groups.ends.push_back(static_cast<std::uint32_t>(groups.half_edges.size()));
      groups.half_edges.push_back(run[i].half_edge);
    }
    if (!run.empty()) groups.ends.push_back(static_cast<std::uint32_t>(groups.half_edges.size()));
  }
  return groups;
}

DisjointSets::DisjointSets(std::size_t size) : parent_(size), side_(size, 0) {
  for (std::uint32_t i = 0; i < size; ++i)
    parent_[i] = i;
}

DisjointSets::Found DisjointSets::find(std::uint32_t element) {
  // Path halving: each element passed is hung below its grandparent.
  char side = 0;
  while (parent_[element] != element) {
    const std::uint32_t parent = parent_[element];
    side_[element] = static_cast<char>(side_[element] ^ side_[parent]);
    parent_[element] = parent_[parent];
    side = static_cast<char>(side ^ side_[element]);
    element = parent_[element];
  }
  return {element, static_cast<std::uint32_t>(side)};
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b, bool turned) {
  const Found found_a = find(a), found_b = find(b);
  if (found_a.root == found_b.root) return;
  const auto [root, child] = std::minmax(found_a.root, found_b.root);
  parent_[child] = root;
  side_[child] = static_cast<char>(found_a.side ^ found_b.side ^ (turned ? 1U : 0U));
}

}  // namespace ds

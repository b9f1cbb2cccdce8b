// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_outward.h"

#include "tracer/scene/mesh_inside.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace ds {
namespace {

/// A connected surface; triangles are numbered as in `all`, the caller's and then the flat ones.
struct Component {
  std::vector<std::uint32_t> triangles;
  std::uint64_t turned = 0;  ///< of them, against the first one
  bool closed = true;
  /// Six times the volume with its triangles wound as most of them are; 0 where it has none that
  /// rounding would not make.
  double volume = 0;
  bool turns_round = false;  ///< those wound as most are; else those wound against them
};

struct Components {
  std::vector<std::uint32_t> of;  ///< component of each triangle
  std::vector<char> side;         ///< 1: wound against the component's first triangle
  std::vector<Component> list;
};

std::vector<Triangle> joined(std::span<const Triangle> a, std::span<const Triangle> b) {
  std::vector<Triangle> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

Components find_components(std::span<const Triangle> all, std::span<const std::uint32_t> welded,
                           const EdgeGroups& edges) {
  DisjointSets sets(all.size());
  edges.for_each([&](std::span<const std::uint32_t> edge) {
    if (edge.size() != 2) return;
    // Neighbours wound alike run along their edge in opposite directions.
    const bool turned = start_of(all, welded, edge[0]) == start_of(all, welded, edge[1]);
    sets.join(edge[0] / 3, edge[1] / 3, turned);
  });
  Components found;
  found.of.resize(all.size());
  found.side.resize(all.size());
  std::vector<std::uint32_t> number(all.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    const DisjointSets::Found at = sets.find(t);  // the root is the set's first triangle
    if (at.root == t) {
      number[t] = static_cast<std::uint32_t>(found.list.size());
      found.list.emplace_back();
    }
    found.of[t] = number[at.root];
    found.side[t] = static_cast<char>(at.side);
    Component& component = found.list[found.of[t]];
    component.triangles.push_back(t);
    component.turned += at.side;
  }
  return found;
}

/// Marks as open what has an edge with more triangles on one side than on the other.
void find_open(std::span<const Triangle> all, std::span<const std::uint32_t> welded,
               const EdgeGroups& edges, Components& components) {
  std::vector<std::int32_t> balance(components.list.size(), 0);
  edges.for_each([&](std::span<const std::uint32_t> edge) {
    for (const std::uint32_t h : edge) {
      const bool upwards = start_of(all, welded, h) < start_of(all, welded, next_half_edge(h));
      balance[components.of[h / 3]] += upwards != (components.side[h / 3] != 0) ? 1 : -1;
    }
    for (const std::uint32_t h : edge) {
      std::int32_t& sum = balance[components.of[h / 3]];
      if (sum != 0) components.list[components.of[h / 3]].closed = false;
    }
    for (const std::uint32_t h : edge)
      balance[components.of[h / 3]] = 0;
  });
}

/// Six times the signed volume, about the first corner so that a far surface keeps its digits.
void measure(std::span<const Vec3d> positions, std::span<const Triangle> all,
             const std::vector<char>& side, Component& component) {
  constexpr double k_sum_rounding = 0x1p-40;  // of a million terms of a few roundings of 2^-53 each
  const bool mostly_turned = 2 * component.turned > component.triangles.size();
  const Vec3d origin = positions[all[component.triangles[0]][0]];
  double sum = 0, size = 0;
  for (const std::uint32_t t : component.triangles) {
    const Vec3d a = positions[all[t][0]];
    const Vec3d area = cross(positions[all[t][1]] - a, positions[all[t][2]] - a);
    const double term = dot(a - origin, area);
    sum += (side[t] != 0) != mostly_turned ? -term : term;
    size += length(a - origin) * length(area);
  }
  component.volume = std::fabs(sum) > k_sum_rounding * size ? sum : 0;
}

/// Decides which closed components turn round: those around which there is none where their volume
/// is negative, and all others as the outermost one around them.
void decide(std::span<const Vec3d> positions, std::span<const Triangle> all,
            Components& components) {
  constexpr std::size_t k_most_outermost = 1000;
  std::vector<Component*> closed;
  for (Component& c : components.list)
    if (c.closed && c.volume != 0) closed.push_back(&c);
  std::stable_sort(closed.begin(), closed.end(), [](const Component* a, const Component* b) {
    return std::fabs(a->volume) > std::fabs(b->volume);
  });
  // A surface as large as what is around it has the same volume or less, and one wound as that
  // needs no look.
  std::vector<MeshInside> outermost[2];
  for (Component* c : closed) {
    const bool inwards = c->volume < 0;
    const MeshInside own(positions, all, c->triangles);
    std::vector<MeshInside>& others = outermost[inwards ? 0 : 1];
    const bool inside_other = std::any_of(others.begin(), others.end(),
                                          [&](MeshInside& around) { return around.holds(own); });
    c->turns_round = inwards != inside_other;
    std::vector<MeshInside>& alike = outermost[inwards ? 1 : 0];
    if (!inside_other && alike.size() < k_most_outermost) alike.push_back(own);
  }
}

/// Which of the triangles are of open surfaces, beside the report.
struct Turned {
  WindingReport report;
  std::vector<std::uint32_t> open;
};

Turned turn_closed(std::span<const Vec3d> positions, std::span<const std::uint32_t> welded,
                   std::vector<Triangle>& triangles, std::span<const Triangle> flat) {
  const std::vector<Triangle> all = joined(triangles, flat);
  const EdgeGroups edges = group_edges(all, welded);
  Components components = find_components(all, welded, edges);
  find_open(all, welded, edges, components);
  for (Component& c : components.list)
    if (c.closed) measure(positions, all, components.side, c);
  decide(positions, all, components);

  Turned found;
  for (const Component& c : components.list) {
    const bool mostly_turned = 2 * c.turned > c.triangles.size();
    for (const std::uint32_t t : c.triangles) {
      if (t >= triangles.size()) continue;
      const bool against = (components.side[t] != 0) != mostly_turned;
      if (!c.closed || c.volume == 0) {
        found.report.against += against ? 1 : 0;
        if (!c.closed) found.open.push_back(t);
      } else if (against != c.turns_round) {
        std::swap(triangles[t][1], triangles[t][2]);
        ++found.report.turned;
      }
    }
  }
  return found;
}

bool has_three_places(const Triangle& t, std::span<const std::uint32_t> welded) {
  const std::uint32_t a = welded[t[0]], b = welded[t[1]], c = welded[t[2]];
  return a != b && b != c && c != a;
}

}  // namespace

WindingReport turn_outwards(std::span<const Vec3d> positions, std::span<const std::uint32_t> welded,
                            std::vector<Triangle>& triangles, std::span<const Triangle> flat) {
  Turned exact = turn_closed(positions, welded, triangles, flat);
  if (exact.open.empty()) return exact.report;
  const std::vector<std::uint32_t> near = weld_seams(positions);
  if (std::equal(near.begin(), near.end(), welded.begin(), welded.end())) return exact.report;
  std::sort(exact.open.begin(), exact.open.end());
  std::erase_if(exact.open, [&](std::uint32_t t) { return !has_three_places(triangles[t], near); });
  std::vector<Triangle> open, thin;
  for (const std::uint32_t t : exact.open)
    open.push_back(triangles[t]);
  std::copy_if(flat.begin(), flat.end(), std::back_inserter(thin),
               [&](const Triangle& t) { return has_three_places(t, near); });
  const Turned again = turn_closed(positions, near, open, thin);
  if (again.open.size() == open.size()) return exact.report;
  for (std::size_t i = 0; i < open.size(); ++i)
    triangles[exact.open[i]] = open[i];
  return {exact.report.turned + again.report.turned, again.report.against};
}

}  // namespace ds

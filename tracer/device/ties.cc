// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/ties.h"

#include "tracer/base/hash_stream.h"
#include "tracer/device/program_text.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

/// Tied triangles are at most this much out of parallel: k_tie_cosine of kernels/ties.cl, and less,
/// so that every pair found here is one there.
constexpr double k_parallel = 0.9991;
/// Overlaps narrower than this share of the smaller triangle are neighbours' common edges.
constexpr double k_overlap = 1e-3;

/// A triangle as pairs are judged by.
struct Face {
  std::array<Vec3d, 3> corner;
  Vec3d normal;  ///< unit, or zero without area
  Box3 box;
  double extent, error;  ///< error: kernels' position_error
};

double greatest(Vec3d v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

Face face_of(const Corners& c) {
  const auto real3_of = [](Vec3 v) { return kernels::vec(v.x, v.y, v.z); };
  Face f;
  for (std::size_t i = 0; i < 3; ++i)
    f.corner[i] = to_double(c[i]);
  const Vec3d e1 = f.corner[1] - f.corner[0], e2 = f.corner[2] - f.corner[0];
  f.extent = std::max({greatest(e1), greatest(e2), greatest(e2 - e1)});
  f.normal = f.extent > 0 ? normalized(cross(e1 * (1 / f.extent), e2 * (1 / f.extent))) : Vec3d{};
  f.box = {f.corner[0], f.corner[0]};
  for (const Vec3d& p : f.corner) {
    f.box.low = {std::min(f.box.low.x, p.x), std::min(f.box.low.y, p.y),
                 std::min(f.box.low.z, p.z)};
    f.box.high = {std::max(f.box.high.x, p.x), std::max(f.box.high.y, p.y),
                  std::max(f.box.high.z, p.z)};
  }
  f.error =
      double{kernels::position_error(real3_of(c[0]), real3_of(c[1] - c[0]), real3_of(c[2] - c[0]))};
  return f;
}

/// Whether the face reaches within `reach` of the other's plane.
bool reaches_plane(const Face& face, const Face& plane, double reach) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3d& p : face.corner) {
    const double height = dot(plane.normal, p - plane.corner[0]);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return low <= reach && high >= -reach;
}

/// Whether some edge of `a` has `b` beyond it, but for `slack`.
bool is_beyond_an_edge(const Face& a, const Face& b, double slack) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d out = normalized(cross(a.corner[(i + 1) % 3] - a.corner[i], a.normal));
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : b.corner)
      nearest = std::min(nearest, dot(out, p - a.corner[i]));
    if (nearest >= -slack) return true;
  }
  return false;
}

bool tie(const Face& a, const Face& b) {
  const double reach = a.error + b.error;
  return std::fabs(dot(a.normal, b.normal)) >= k_parallel && reaches_plane(a, b, reach) &&
         reaches_plane(b, a, reach) &&
         !is_beyond_an_edge(a, b, k_overlap * std::min(a.extent, b.extent)) &&
         !is_beyond_an_edge(b, a, k_overlap * std::min(a.extent, b.extent));
}

/// Both in the same plane across an axis, to the last bit: rays tell their side of it exactly.
bool same_axis_plane(const Corners& a, const Corners& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const float place = a[0][axis];
    if (a[1][axis] == place && a[2][axis] == place && b[0][axis] == place && b[1][axis] == place &&
        b[2][axis] == place)
      return true;
  }
  return false;
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d p0 = to_double(mesh.positions[t[0]]);
    sum += 0.5 * length(cross(to_double(mesh.positions[t[1]]) - p0,
                              to_double(mesh.positions[t[2]]) - p0));
  }
  return sum;
}

/// By object. Beyond the last rank that a triangle's word can tell, ties stay undecided.
std::vector<std::uint32_t> ranks(const Scene& scene) {
  struct Place {
    bool model, shines;
    double area;
  };
  std::vector<Place> places;
  for (const Object& object : scene.objects)
    places.push_back(
        {object.id == k_model_object_id,
         object.material >= 0 && shines(scene.materials[static_cast<std::size_t>(object.material)]),
         area_of(object.mesh)});
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (places[a].model != places[b].model) return places[a].model;
    if (places[a].shines != places[b].shines) return places[a].shines;
    return places[a].area < places[b].area;
  });
  std::vector<std::uint32_t> rank(places.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    rank[order[i]] =
        static_cast<std::uint32_t>(std::min(i, static_cast<std::size_t>(kernels::k_most_tie_rank)));
  return rank;
}

/// Calls `visit` with each triangle of a leaf whose box meets `box`, some more than once.
template <typename Visit>
void visit_triangles(const Bvh& bvh, const Box3& box, const Visit& visit) {
  constexpr std::size_t width = kernels::k_bvh_width;
  const std::array<double, 6> bounds = {box.low.x,  box.high.x, box.low.y,
                                        box.high.y, box.low.z,  box.high.z};
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) {
    const std::uint32_t current = stack.back();
    stack.pop_back();
    if ((current & 0x80000000u) != 0) {
      const float* leaf = bvh.leaves.data() + std::size_t{current & 0x7fffffffu} *
                                                  std::size_t{kernels::k_leaf_vectors} * width;
      for (std::size_t i = 0; i < width; ++i)
        visit(std::bit_cast<std::uint32_t>(leaf[kernels::k_leaf_ids * width + i]));
      continue;
    }
    const float* node =
        bvh.nodes.data() + std::size_t{current} * std::size_t{kernels::k_node_vectors} * width;
    for (std::size_t i = 0; i < width; ++i) {
      bool meets = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        meets = meets && double{node[2 * axis * width + i]} <= bounds[2 * axis + 1] &&
                double{node[(2 * axis + 1) * width + i]} >= bounds[2 * axis];
      if (meets)
        stack.push_back(std::bit_cast<std::uint32_t>(node[kernels::k_node_children * width + i]));
    }
  }
}

Box3 grown(const Box3& box, double by) {
  const Vec3d margin{by, by, by};
  return {box.low - margin, box.high + margin};
}

class PairFinder {
 public:
  PairFinder(const Scene& scene, std::span<const Corners> triangles, const Bvh& bvh)
      : scene_(scene), triangles_(triangles), bvh_(bvh), first_(scene.objects.size() + 1, 0) {
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
      const std::size_t count = scene.objects[o].mesh.triangles.size();
      owner_.insert(owner_.end(), count, o);
      first_[o + 1] = first_[o] + static_cast<std::uint32_t>(count);
    }
    for (const Corners& c : triangles)
      worst_ = std::max(worst_, error_of(c));
  }

  /// Among the first `count` objects. A pair is found from either side, so the one of most triangles
  /// need not look.
  TiePairs among(std::uint32_t count) const {
    TiePairs found;
    std::uint32_t most = 0;
    for (std::uint32_t o = 1; o < count; ++o)
      if (size_of(o) > size_of(most)) most = o;
    for (std::uint32_t o = 0; o < count; ++o)
      if (o != most)
        look(
            o, [&](std::uint32_t other) { return other < count && (other == most || other < o); },
            found);
    return found;
  }
  /// Between the last object and those before it.
  void add_of_last(TiePairs& found) const {
    const auto last = static_cast<std::uint32_t>(scene_.objects.size() - 1);
    if (size_of(last) <= first_[last]) {
      look(
          last, [&](std::uint32_t other) { return other != last; }, found);
      return;
    }
    for (std::uint32_t o = 0; o < last; ++o)
      look(
          o, [&](std::uint32_t other) { return other == last; }, found);
  }
  std::uint32_t first_of_last() const { return first_[scene_.objects.size() - 1]; }
  std::uint32_t owner(std::uint32_t triangle) const { return owner_[triangle]; }

 private:
  static double error_of(const Corners& c) {
    const auto real3_of = [](Vec3 v) { return kernels::vec(v.x, v.y, v.z); };
    return double{
        kernels::position_error(real3_of(c[0]), real3_of(c[1] - c[0]), real3_of(c[2] - c[0]))};
  }
  std::uint32_t size_of(std::uint32_t object) const { return first_[object + 1] - first_[object]; }

  /// From each of the object's triangles at those of the objects that `wanted` names.
  template <typename Wanted>
  void look(std::uint32_t object, const Wanted& wanted, TiePairs& found) const {
    std::vector<std::uint32_t> near;
    for (std::uint32_t id = first_[object]; id < first_[object + 1]; ++id) {
      const Face face = face_of(triangles_[id]);
      near.clear();
      visit_triangles(bvh_, grown(face.box, face.error + worst_), [&](std::uint32_t other) {
        if (owner_[other] != object && wanted(owner_[other])) near.push_back(other);
      });
      // A tree may name one more than once.
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      for (const std::uint32_t other : near) {
        const Face against = face_of(triangles_[other]);
        // Which are looked at depends on the tree, and which tie must not.
        if (meet(grown(face.box, face.error + against.error), against.box) && tie(face, against))
          found.pairs.push_back({id, other});
      }
    }
  }

  const Scene& scene_;
  std::span<const Corners> triangles_;
  const Bvh& bvh_;
  std::vector<std::uint32_t> first_;  ///< triangle of each object, and the end
  std::vector<std::uint32_t> owner_;
  double worst_ = 0;
};

TiePairs find_pairs(const Scene& scene, std::span<const Corners> triangles,
                    const PairFinder& finder, Kept<TiePairs>* cache) {
  const auto objects = static_cast<std::uint32_t>(scene.objects.size());
  if (cache == nullptr) return finder.among(objects);
  HashStream key;
  key.add(hash_bytes(std::as_bytes(triangles.first(finder.first_of_last()))));
  for (const Object& object : scene.objects)
    key.add(&object == &scene.objects.back() ? "."
                                             : fmt::format("{} ", object.mesh.triangles.size()));
  TiePairs pairs = *cache->get(key.hash(), [&] { return finder.among(objects - 1); });
  finder.add_of_last(pairs);
  return pairs;
}

/// What triangles are marked with, pair by pair.
class Marks {
 public:
  Marks(const Scene& scene, std::span<const Corners> triangles)
      : triangles_(triangles), rank_(ranks(scene)) {
    ties_.flags.assign(triangles.size(), 0);
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t owner_a, std::uint32_t owner_b) {
    const std::uint32_t rank_a = rank_[owner_a], rank_b = rank_[owner_b];
    if (rank_a == rank_b) return;
    const Face face_a = face_of(triangles_[a]), face_b = face_of(triangles_[b]);
    ties_.flags[a] |= rank_a < rank_b ? kernels::k_flag_covers : kernels::k_flag_covered;
    ties_.flags[b] |= rank_b < rank_a ? kernels::k_flag_covers : kernels::k_flag_covered;
    const double error = std::max(face_a.error, face_b.error);
    const bool rounded = !same_axis_plane(triangles_[a], triangles_[b]);
    for (const auto& [id, rank] : {std::pair(a, rank_a), std::pair(b, rank_b)}) {
      Mark& mark = marks_[id];
      mark.error = std::max(mark.error, error);
      mark.rank = rank;
      if (rounded) ties_.flags[id] |= kernels::k_flag_tie_rounded;
    }
    // Where both are; of hits' places along rays that graze, more than rounding is uncertain.
    const Box3 p = grown(face_a.box, error), q = grown(face_b.box, error);
    const Box3 both = {
        {std::max(p.low.x, q.low.x), std::max(p.low.y, q.low.y), std::max(p.low.z, q.low.z)},
        {std::min(p.high.x, q.high.x), std::min(p.high.y, q.high.y), std::min(p.high.z, q.high.z)}};
    places_.add(grown(both, 1000 * error + 0.01 * greatest(both.high - both.low)));
  }

  Ties take() {
    for (const auto& [id, mark] : marks_) {
      // The next power of two.
      const std::uint32_t exponent =
          (std::bit_cast<std::uint32_t>(static_cast<float>(mark.error)) >> 23) + 1;
      ties_.flags[id] |= std::min(exponent, 254u) << kernels::k_tie_error_shift;
      ties_.flags[id] |= mark.rank << kernels::k_tie_rank_shift;
    }
    ties_.places = places_.take();
    return std::move(ties_);
  }

 private:
  struct Mark {
    double error = 0;
    std::uint32_t rank = 0;
  };
  std::span<const Corners> triangles_;
  std::vector<std::uint32_t> rank_;
  std::map<std::uint32_t, Mark> marks_;  ///< by triangle
  TiePlaces places_;
  Ties ties_;
};

}  // namespace

Ties find_ties(const Scene& scene, std::span<const Corners> triangles, const Bvh& bvh,
               Kept<TiePairs>* cache) {
  const PairFinder finder(scene, triangles, bvh);
  Marks marks(scene, triangles);
  for (const auto& [a, b] : find_pairs(scene, triangles, finder, cache).pairs)
    marks.add(a, b, finder.owner(a), finder.owner(b));
  return marks.take();
}

}  // namespace ds

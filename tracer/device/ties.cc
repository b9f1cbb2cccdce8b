// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/ties.h"

#include "tracer/device/program_text.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

/// Tied triangles are at most this much out of parallel: k_tie_cosine of kernels/ties.cl, and less,
/// so that every pair found here is one there.
constexpr double k_parallel = 0.9991;
/// Overlaps narrower than this share of the smaller triangle are neighbours' common edges.
constexpr double k_overlap = 1e-3;

struct Box3 {
  Vec3d low, high;
};

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

class TieFinder {
 public:
  TieFinder(const Scene& scene, std::span<const Corners> triangles, const Bvh& bvh)
      : triangles_(triangles), bvh_(bvh), rank_(ranks(scene)) {
    ties_.flags.assign(triangles.size(), 0);
    error_.assign(triangles.size(), 0);
    faces_.reserve(triangles.size());
    for (const Corners& c : triangles)
      faces_.push_back(face_of(c));
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o)
      owner_.insert(owner_.end(), scene.objects[o].mesh.triangles.size(), o);
  }

  /// A pair is found from either side, so the object of most triangles need not look.
  Ties find(const Scene& scene) {
    const auto most = std::max_element(scene.objects.begin(), scene.objects.end(),
                                       [](const Object& a, const Object& b) {
                                         return a.mesh.triangles.size() < b.mesh.triangles.size();
                                       });
    const auto skipped = static_cast<std::uint32_t>(most - scene.objects.begin());
    double worst = 0;
    for (const Face& face : faces_)
      worst = std::max(worst, face.error);
    for (std::uint32_t id = 0; id < faces_.size(); ++id)
      if (owner_[id] != skipped)
        visit_triangles(bvh_, grown(faces_[id].box, worst),
                        [&](std::uint32_t other) { judge(id, other); });
    finish();
    return std::move(ties_);
  }

 private:
  void judge(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t rank_a = rank_[owner_[a]], rank_b = rank_[owner_[b]];
    if (rank_a == rank_b || !tie(faces_[a], faces_[b])) return;
    ties_.flags[a] |= rank_a < rank_b ? kernels::k_flag_covers : kernels::k_flag_covered;
    ties_.flags[b] |= rank_b < rank_a ? kernels::k_flag_covers : kernels::k_flag_covered;
    const double error = std::max(faces_[a].error, faces_[b].error);
    const bool rounded = !same_axis_plane(triangles_[a], triangles_[b]);
    for (const std::uint32_t id : {a, b}) {
      error_[id] = std::max(error_[id], error);
      if (rounded) ties_.flags[id] |= kernels::k_flag_tie_rounded;
    }
    // Where both are; of hits' places along rays that graze, more than rounding is uncertain.
    const Box3 p = grown(faces_[a].box, error), q = grown(faces_[b].box, error);
    const Box3 both = {
        {std::max(p.low.x, q.low.x), std::max(p.low.y, q.low.y), std::max(p.low.z, q.low.z)},
        {std::min(p.high.x, q.high.x), std::min(p.high.y, q.high.y), std::min(p.high.z, q.high.z)}};
    const Box3 place = grown(both, 100 * error + 0.01 * greatest(both.high - both.low));
    low_ = {std::min(low_.x, place.low.x), std::min(low_.y, place.low.y),
            std::min(low_.z, place.low.z)};
    high_ = {std::max(high_.x, place.high.x), std::max(high_.y, place.high.y),
             std::max(high_.z, place.high.z)};
  }

  void finish() {
    for (std::uint32_t id = 0; id < ties_.flags.size(); ++id) {
      if (ties_.flags[id] == 0) continue;
      // The next power of two.
      const std::uint32_t exponent =
          (std::bit_cast<std::uint32_t>(static_cast<float>(error_[id])) >> 23) + 1;
      ties_.flags[id] |= std::min(exponent, 254u) << kernels::k_tie_error_shift;
      ties_.flags[id] |= rank_[owner_[id]] << kernels::k_tie_rank_shift;
    }
    for (int axis = 0; axis < 3; ++axis) {
      ties_.low[static_cast<std::size_t>(axis)] = static_cast<float>(low_[axis]);
      ties_.high[static_cast<std::size_t>(axis)] = static_cast<float>(high_[axis]);
    }
  }

  std::span<const Corners> triangles_;
  const Bvh& bvh_;
  std::vector<std::uint32_t> rank_, owner_;
  std::vector<Face> faces_;
  std::vector<double> error_;
  Vec3d low_{1e30, 1e30, 1e30}, high_{-1e30, -1e30, -1e30};
  Ties ties_;
};

}  // namespace

Ties find_ties(const Scene& scene, std::span<const Corners> triangles, const Bvh& bvh) {
  return TieFinder(scene, triangles, bvh).find(scene);
}

}  // namespace ds

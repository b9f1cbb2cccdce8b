// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ds {
namespace {

/// An edge of more triangles than this smooths none of them: trying all pairs must stay cheap.
constexpr std::size_t k_most_at_edge = 16;
/// In a fan of more corners than this, all share the sum of all, for the same reason.
constexpr std::size_t k_most_in_fan = 512;

/// Taken off the cosine of the crease, so that faces that meet at the crease angle itself (coplanar
/// ones at 0, those of a box at 90 degrees) do not fall on either side by rounding.
constexpr double k_crease_rounding = 1e-12;

/// arctan of x in [0, 1]: halved twice by arctan x = 2 arctan(x / (1 + sqrt(1 + x^2))), which
/// brings x below 0.199, then the Taylor series, whose first term left out is below 0.199^25 / 25
/// = 1.2e-19.
double arctangent(double x) {
  for (int i = 0; i < 2; ++i)
    x = x / (1.0 + std::sqrt(1.0 + x * x));
  const double minus_square = -(x * x);
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2)
    sum = sum * minus_square + 1.0 / k;
  return 4.0 * x * sum;
}

struct Fans {
  std::vector<std::uint32_t> corners;  ///< grouped by fan, ascending within each
  std::vector<std::uint32_t> ends;
};

/// Joins the corners on both ends of every edge that two triangles are smooth over.
void join_over_edge(std::span<const std::uint32_t> edge, std::span<const Triangle> triangles,
                    std::span<const std::uint32_t> welded, std::span<const Vec3d> normals,
                    double crease_cosine, DisjointSets& corners) {
  if (edge.size() > k_most_at_edge) return;
  for (std::size_t i = 0; i < edge.size(); ++i)
    for (std::size_t j = i + 1; j < edge.size(); ++j) {
      const std::uint32_t a = edge[i], b = edge[j];
      // Wound alike: they run along the edge in opposite directions.
      if (start_of(triangles, welded, a) == start_of(triangles, welded, b)) continue;
      if (dot(normals[a / 3], normals[b / 3]) < crease_cosine) continue;
      corners.join(a, next_half_edge(b));
      corners.join(next_half_edge(a), b);
    }
}

Fans find_fans(std::span<const Triangle> triangles, std::span<const std::uint32_t> welded,
               std::span<const Vec3d> normals, double crease_cosine) {
  const std::size_t count = 3 * triangles.size();
  DisjointSets sets(count);
  group_edges(triangles, welded).for_each([&](std::span<const std::uint32_t> edge) {
    join_over_edge(edge, triangles, welded, normals, crease_cosine, sets);
  });
  // Counting sort by root.
  std::vector<std::uint32_t> roots(count), starts(count + 1, 0);
  for (std::uint32_t c = 0; c < count; ++c) {
    roots[c] = sets.find(c).root;
    ++starts[roots[c] + 1];
  }
  for (std::size_t i = 1; i <= count; ++i)
    starts[i] += starts[i - 1];
  Fans fans;
  fans.corners.resize(count);
  fans.ends.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    if (starts[i + 1] != starts[i]) fans.ends.push_back(starts[i + 1]);
  for (std::uint32_t c = 0; c < count; ++c)
    fans.corners[starts[roots[c]]++] = c;
  return fans;
}

/// Unit normal * area * angle for each corner. The constant factor 2 of the area does not matter.
std::vector<Vec3d> weighted_normals(std::span<const Vec3d> positions,
                                    std::span<const Triangle> triangles) {
  std::vector<Vec3d> weighted;
  weighted.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = positions[t[k]];
      const Vec3d to_next = positions[t[(k + 1) % 3]] - a;
      const Vec3d to_previous = positions[t[(k + 2) % 3]] - a;
      const Vec3d area = cross(to_next, to_previous);
      weighted.push_back(area * angle_between(length(area), dot(to_next, to_previous)));
    }
  return weighted;
}

class FanShader {
 public:
  FanShader(std::span<const Vec3d> normals, std::span<const Vec3d> weighted, double crease_deg)
      : normals_(normals),
        weighted_(weighted),
        crease_cosine_(cosine_deg(crease_deg) - k_crease_rounding),
        half_crease_cosine_(cosine_deg(crease_deg / 2)) {}

  void shade(std::span<const std::uint32_t> fan, std::vector<Vec3d>& out) const {
    Vec3d sum;
    for (const std::uint32_t corner : fan)
      sum = sum + weighted_[corner];
    const bool one_normal = fan.size() > k_most_in_fan || all_near(fan, normalized(sum));
    for (const std::uint32_t corner : fan) {
      const Vec3d normal = normals_[corner / 3];
      const Vec3d smooth = normalized(one_normal ? sum : sum_within_crease(fan, normal));
      out[corner] = dot(smooth, normal) > 0 ? smooth : normal;
    }
  }

 private:
  /// Whether all are within half the crease of the mean, and so within the crease of each other.
  bool all_near(std::span<const std::uint32_t> fan, Vec3d mean) const {
    return std::all_of(fan.begin(), fan.end(), [&](std::uint32_t corner) {
      return dot(normals_[corner / 3], mean) >= half_crease_cosine_;
    });
  }
  Vec3d sum_within_crease(std::span<const std::uint32_t> fan, Vec3d normal) const {
    Vec3d sum;
    for (const std::uint32_t corner : fan)
      if (dot(normals_[corner / 3], normal) >= crease_cosine_) sum = sum + weighted_[corner];
    return sum;
  }

  std::span<const Vec3d> normals_;
  std::span<const Vec3d> weighted_;
  double crease_cosine_;
  double half_crease_cosine_;
};

}  // namespace

double angle_between(double sine_part, double cosine_part) {
  const double cosine_size = std::fabs(cosine_part);
  if (sine_part == 0 && cosine_size == 0) return 0;
  const double acute = sine_part <= cosine_size
                           ? arctangent(sine_part / cosine_size)
                           : std::numbers::pi / 2 - arctangent(cosine_size / sine_part);
  return cosine_part < 0 ? std::numbers::pi - acute : acute;
}

double cosine_deg(double degrees) {
  if (degrees > 90) return -cosine_deg(180 - degrees);
  // Taylor series on [0, pi / 4], then cos 2x = 2 cos^2 x - 1; the first term left out is below
  // (pi / 4)^18 / 18! = 2e-18.
  const double half = degrees / 360 * std::numbers::pi;
  const double minus_square = -(half * half);
  double sum = 1;
  for (int k = 16; k >= 2; k -= 2)
    sum = 1 + sum * minus_square / (k * (k - 1));
  return degrees == 90 ? 0 : 2 * sum * sum - 1;
}

std::vector<Vec3d> face_normals(std::span<const Vec3d> positions,
                                std::span<const Triangle> triangles) {
  std::vector<Vec3d> normals;
  normals.reserve(triangles.size());
  for (const Triangle& t : triangles)
    normals.push_back(
        normalized(cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]])));
  return normals;
}

std::vector<Vec3d> smooth_corner_normals(std::span<const Vec3d> positions,
                                         std::span<const Triangle> triangles,
                                         std::span<const std::uint32_t> welded, double crease_deg) {
  const std::vector<Vec3d> normals = face_normals(positions, triangles);
  const std::vector<Vec3d> weighted = weighted_normals(positions, triangles);
  const Fans fans =
      find_fans(triangles, welded, normals, cosine_deg(crease_deg) - k_crease_rounding);
  const FanShader shader(normals, weighted, crease_deg);
  std::vector<Vec3d> out(3 * triangles.size());
  std::size_t begin = 0;
  for (const std::uint32_t end : fans.ends) {
    shader.shade(std::span(fans.corners).subspan(begin, end - begin), out);
    begin = end;
  }
  return out;
}

}  // namespace ds

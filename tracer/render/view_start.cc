// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/view.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace ds {
namespace {

/// A pixel below this, in radians, is a narrow one: 400 times the angle under which two half-ulps of
/// a camera's distance from what it sees are seen from there. No picture of 49 degrees has any.
constexpr double k_narrow_pixel = 5e-5;

/// Rays start this share of their start's distances (from the camera, and from the world's origin)
/// before what they could meet: several times what rounding the start to floats moves it.
constexpr double k_margin = 1e-6;

/// Whatever the rays of a picture can pass: before the camera, and from a rectangle that holds their
/// starts in its plane on to sides of these slopes. Coordinates are right, up and forward of the
/// camera.
struct Reach {
  Vec3d position;
  CameraFrame frame;
  double slope_x = 0, slope_y = 0, start_x = 0, start_y = 0;

  Vec3d seen(Vec3 point) const {
    const Vec3d way = to_double(point) - position;
    return {dot(way, frame.right), dot(way, frame.up), dot(way, frame.forward)};
  }
  /// How far inside the planes around it; negative: outside.
  std::array<double, 5> inside(Vec3d p) const {
    const double x = start_x + slope_x * p.z, y = start_y + slope_y * p.z;
    return {p.z, x - p.x, x + p.x, y - p.y, y + p.y};
  }
};

Reach reach_of(const Camera& camera, int width, int height) {
  constexpr double k_wider = 1 + 1e-6;  // floats round pixels' places and the slopes
  const double longer = std::max(width, height);
  const kernels::CameraShape shape = type_of(camera).host.shape(span_of(camera));
  const double half = shape.per_metre * k_wider, start = shape.at_camera_m * k_wider;
  const double lens = camera.lens_radius_m * k_wider;
  const double spread = lens > 0 ? lens / camera.focus_distance_m : 0;
  return {camera.position,
          camera_frame(camera),
          half * width / longer + spread,
          half * height / longer + spread,
          start * width / longer + lens,
          start * height / longer + lens};
}

/// The part of a convex polygon inside plane `side` of the reach.
void clip(const Reach& reach, std::size_t side, std::vector<Vec3d>& polygon,
          std::vector<Vec3d>& kept) {
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double from = reach.inside(a)[side], to = reach.inside(b)[side];
    if (from >= 0) kept.push_back(a);
    if ((from >= 0) != (to >= 0)) kept.push_back(a + (b - a) * (from / (from - to)));
  }
  polygon.swap(kept);
}

/// Depth of the nearest place of a mesh that rays can meet; infinite where there is none.
double nearest_depth(const Reach& reach, const Mesh& mesh, double nearest) {
  std::vector<Vec3d> polygon, kept;
  for (const auto& t : mesh.triangles) {
    polygon.clear();
    for (const std::uint32_t v : t)
      polygon.push_back(reach.seen(mesh.positions[v]));
    if (std::min({polygon[0].z, polygon[1].z, polygon[2].z}) >= nearest) continue;
    for (std::size_t side = 0; side < 5 && !polygon.empty(); ++side)
      clip(reach, side, polygon, kept);
    for (const Vec3d p : polygon)
      nearest = std::min(nearest, p.z);
  }
  return nearest;
}

}  // namespace

double ray_start_m(const Scene& scene, const Camera& camera, int width, int height) {
  const kernels::CameraShape shape = type_of(camera).host.shape(span_of(camera));
  // As wide as it is at the target.
  const double slope =
      shape.per_metre + shape.at_camera_m / length(camera.target - camera.position);
  if (!(2 * slope < k_narrow_pixel * std::max(width, height))) return 0;
  const Reach reach = reach_of(camera, width, height);
  constexpr double k_nothing = std::numeric_limits<double>::infinity();
  double nearest = k_nothing;
  for (const Object& object : scene.objects)
    nearest = nearest_depth(reach, object.mesh, nearest);
  if (nearest == k_nothing) return 0;
  const Vec3d place = camera.position + reach.frame.forward * nearest;
  return std::max(0.0, nearest - k_margin * (nearest + length(place)));
}

}  // namespace ds

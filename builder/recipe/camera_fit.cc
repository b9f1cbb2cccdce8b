// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/camera_fit.h"

#include "manifests/camera_geometry.h"
#include "tracer/base/error.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ds {
namespace {

Vec3d corner_of(const Mesh& mesh, std::uint32_t corner) {
  const Vec3& p = mesh.positions[corner];
  return {double{p.x}, double{p.y}, double{p.z}};
}

/// The least distance at which the sphere is inside the two planes of one axis of the picture.
/// `tangent`: of the half angle; `offset`: the sphere's centre from the target.
double distance_for(double tangent, Vec3d sight, Vec3d side, Vec3d offset, double radius_m) {
  const double cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
  double distance_m = 0;
  for (const double sign : {1.0, -1.0}) {
    const Vec3d inward = sight * sine + side * (sign * cosine);
    distance_m = std::max(distance_m, (radius_m - dot(offset, inward)) / sine);
  }
  return distance_m;
}

}  // namespace

Sphere bounding_sphere(const Mesh& mesh) {
  if (mesh.triangles.empty()) return {};
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  Vec3d low{k_infinity, k_infinity, k_infinity}, high = low * -1;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) {
      const Vec3d p = corner_of(mesh, corner);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  const Vec3d centre = (low + high) * 0.5;
  double most = 0;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) {
      const Vec3d from_centre = corner_of(mesh, corner) - centre;
      most = std::max(most, dot(from_centre, from_centre));
    }
  return {centre, std::sqrt(most)};
}

Camera fit_camera(Camera camera, const CameraFit& fit, const Sphere& sphere, int width,
                  int height) {
  const Vec3d sight = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(sight, camera.up));
  const Vec3d up = cross(right, sight);
  const double longer = std::max(width, height);
  const Vec3d offset = sphere.centre - camera.target;
  double distance_m = 0;
  if (type_of(camera).host.span == kernels::CameraSpan::fov_deg) {
    const double tangent =
        sin_deg(camera.fov_deg / 2) / cos_deg(camera.fov_deg / 2) * (1 - fit.margin) / longer;
    distance_m = std::max(distance_for(tangent * width, sight, right, offset, sphere.radius_m),
                          distance_for(tangent * height, sight, up, offset, sphere.radius_m));
  } else {
    const auto extent_for = [&](Vec3d side, int pixels) {
      return (std::fabs(dot(offset, side)) + sphere.radius_m) * longer / pixels;
    };
    camera.extent_m =
        2 * std::max(extent_for(right, width), extent_for(up, height)) / (1 - fit.margin);
    distance_m = std::max(2 * sphere.radius_m - dot(offset, sight), sphere.radius_m);
  }
  camera.position = camera.target - sight * distance_m;
  if (fit.focus == CameraFit::Focus::distance) return camera;
  const Vec3d sharp = fit.focus == CameraFit::Focus::target ? camera.target : Vec3d{};
  camera.focus_distance_m = dot(sharp - camera.position, sight);
  if (camera.focus_distance_m > 0) return camera;
  if (camera.lens_radius_m > 0)
    fail(
        ErrorKind::recipe,
        "camera.focus must be in front of every camera, got {} m with camera.distance_m = \"fit\"; "
        "\"target\" always is",
        camera.focus_distance_m);
  camera.focus_distance_m = distance_m;  // a pinhole is sharp everywhere: any distance does
  return camera;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <array>
#include <vector>

/// Rays cast in double precision at every triangle in turn, from a manifest's intrinsics and pose:
/// the independent right value for masks, depths and other planes.
namespace ds::ray_caster {

/// What the ray through a pixel's centre meets first.
struct Hit {
  int object = -1;                 ///< index; -1 where nothing is met
  double depth = 0, distance = 0;  ///< planar z, and along the ray; metres
  Vec3d position{};                ///< world
  Vec3d normal{};                  ///< of the triangle, unit, towards the camera
  Vec3d shading{};                 ///< of the corners' normals, unit, on the same side as `normal`
  Vec3d towards{};                 ///< where the ray came from, unit
  double u = 0, v = 0;             ///< of the corners'; 0 where the mesh has none
  int triangle = -1;               ///< of the object's
  double margin = 0;  ///< least barycentric weight: below 1e-4 or so another triangle may be met
};

/// Objects that `sees` is false for are not there. intrinsics and camera_to_world: as
/// manifests/camera_geometry.h gives them. Row 0 is the top.
std::vector<Hit> cast(const std::vector<Object>& objects, const std::vector<bool>& sees,
                      const std::array<double, 9>& intrinsics,
                      const std::array<double, 16>& camera_to_world, int width, int height);

/// The same where rays are parallel and a pixel is so wide.
std::vector<Hit> cast_parallel(const std::vector<Object>& objects, const std::vector<bool>& sees,
                               double metres_per_pixel,
                               const std::array<double, 16>& camera_to_world, int width,
                               int height);

/// Of all that the camera sees, or of the model alone.
std::vector<Hit> cast(const Scene& scene, const Camera& camera, int width, int height);
std::vector<Hit> cast_model(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace ds::ray_caster

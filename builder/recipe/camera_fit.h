// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh.h"
#include "tracer/scene/scene.h"

namespace ds {

/// A ball that holds a model, in metres, in the world.
struct Sphere {
  Vec3d centre;
  double radius_m = 0;

  bool operator==(const Sphere&) const = default;
};

/// Around the middle of the box of the mesh's triangles, through the corner farthest from it. The
/// same bits on every machine. Of a mesh without triangles: the origin, radius 0.
Sphere bounding_sphere(const Mesh& mesh);

/// What camera.distance_m = "fit" leaves to be done for each model.
struct CameraFit {
  /// What is in focus: the plane at the camera's focus_distance_m, or through one of these points.
  enum class Focus { distance, origin, target };

  double margin = 0;  ///< share of the way from the picture's middle to its edge to keep free
  Focus focus = Focus::origin;
};

/// Gives a camera whose rays are parallel the extent that just shows the sphere inside the picture less
/// its margin, and puts it a diameter before the sphere's middle. Moves another along its line of sight
/// to where the sphere is just inside, on all four sides. Focuses either. The direction, not the
/// distance, of `camera.position` from its target counts. With half angles a of the picture less its
/// margin, sight f and side direction s, a side's plane holds the camera and has the inward normal n = f sin a + s cos a; at
/// distance d from the target t the sphere (c, r) is inside where (c - t) n + d sin a >= r.
/// Throws Error(recipe) where what is to be in focus is behind the camera then.
Camera fit_camera(Camera camera, const CameraFit& fit, const Sphere& sphere, int width, int height);

}  // namespace ds

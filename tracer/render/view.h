// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/kernels/layout.h"
#include "tracer/render/render.h"

namespace ds {

/// Counted up where a Schedule steps another way.
inline constexpr int k_schedule_version = 3;

/// Axes of the camera in world space: unit, orthogonal.
struct CameraFrame {
  Vec3d right, up, forward;
};
/// Where the view runs along `camera.up`, +Y stands in for it (and +Z where it runs along that
/// too). Throws Error(recipe) for a target at the position, and for what is not finite or
/// too far (k_farthest_coordinate).
CameraFrame camera_frame(const Camera& camera);

/// How far before the camera, along its forward axis, its rays start: 0, or where a pixel is so
/// narrow that floats would tell it from its neighbour badly, just before the first that any of
/// them could meet. A ray that starts at a camera at 100 km from what it sees is misplaced there by
/// the 8 mm between floats at that distance; one that starts beside it is not, for its start comes
/// from doubles, pixel by pixel.
double ray_start_m(const Scene& scene, const Camera& camera, int width, int height);

/// The constants the kernels take, from the shape of the camera's type; rays start `start_m` before
/// the camera. Throws Error(recipe) for a number of the camera out of its range (scene.h).
kernels::ViewData view_data(const Camera& camera, const EngineSettings& engine, double start_m = 0);

}  // namespace ds

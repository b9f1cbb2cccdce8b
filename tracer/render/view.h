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

/// The constants the kernels take. fov_deg spans the longer side. Throws Error(recipe) for a number
/// of the camera out of its range (scene.h).
kernels::ViewData view_data(const Camera& camera, const EngineSettings& engine);

/// tan of half the angle, degrees in (0, 180), from + - * / and sqrt alone: the same bits on every
/// machine.
double tan_half(double angle_deg);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Perspective camera: pinhole, or thin lens where DS_LENS is defined.
#pragma once

#include "tracer/kernels/sampler.h"
#include "tracer/kernels/types.h"

typedef struct {
  real3 origin, direction;  ///< world; unit direction
} CameraRay;

/// Direction through (x, y) in pixels, row 0 at the top; length such that its part along `forward`
/// is 1.
DS_FN real3 camera_direction(const ViewData* view, real x, real y) {
  const real sx = 2.0f * x / (float)view->width - 1.0f;
  const real sy = 1.0f - 2.0f * y / (float)view->height;
  return vec(
      fma(sx, (real)(view->right[0]), fma(sy, (real)(view->up[0]), (real)(view->forward[0]))),
      fma(sx, (real)(view->right[1]), fma(sy, (real)(view->up[1]), (real)(view->forward[1]))),
      fma(sx, (real)(view->right[2]), fma(sy, (real)(view->up[2]), (real)(view->forward[2]))));
}

DS_FN real3 camera_position(const ViewData* view) {
  return vec((real)(view->position[0]), (real)(view->position[1]), (real)(view->position[2]));
}

#ifdef DS_LENS
DS_FN CameraRay camera_ray(const ViewData* view, real x, real y, real2 lens) {
  const real2 d = concentric_disc(lens);
  const real3 offset = vec(fma(d.x, (real)(view->lens_right[0]), d.y * view->lens_up[0]),
                           fma(d.x, (real)(view->lens_right[1]), d.y * view->lens_up[1]),
                           fma(d.x, (real)(view->lens_right[2]), d.y * view->lens_up[2]));
  CameraRay r;
  r.origin = add(camera_position(view), offset);
  // Towards the point in focus, over the focus distance: a lens of radius 0 gives the pinhole's
  // very bits.
  r.direction =
      unit(sub(camera_direction(view, x, y), scale(offset, (real)(1.0f / view->focus_distance))));
  return r;
}
#else
DS_FN CameraRay camera_ray(const ViewData* view, real x, real y, real2 lens) {
  CameraRay r;
  r.origin = camera_position(view);
  r.direction = unit(camera_direction(view, x, y));
  return r;
}
#endif

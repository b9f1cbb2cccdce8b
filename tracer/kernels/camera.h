// SPDX-License-Identifier: Apache-2.0
// The rays of a camera, pinhole, or thin lens where DS_LENS is defined: their starts and directions
// go evenly over the picture. A camera NAME in cameras/NAME.h says how far, in a DS_HOOK_HOST part, by
// CameraOnHost NAME_on_host of traits.h.
#pragma once

#include "tracer/kernels/sampler.h"
#include "tracer/kernels/view_data.h"

typedef struct {
  real3 origin, direction;  ///< world; unit direction
} CameraRay;

/// A place on a plane that is given by its middle and its right and upper edges, for (x, y) in
/// pixels of the picture, row 0 at the top.
DS_FN real3 on_plane(const ViewData* view, const float* middle, const float* right, const float* up,
                     real x, real y) {
  const real sx = 2.0f * x / (float)view->width - 1.0f;
  const real sy = 1.0f - 2.0f * y / (float)view->height;
  return vec(fma(sx, (real)(right[0]), fma(sy, (real)(up[0]), (real)(middle[0]))),
             fma(sx, (real)(right[1]), fma(sy, (real)(up[1]), (real)(middle[1]))),
             fma(sx, (real)(right[2]), fma(sy, (real)(up[2]), (real)(middle[2]))));
}

/// Direction through (x, y); length such that its part along `forward` is 1.
DS_FN real3 camera_direction(const ViewData* view, real x, real y) {
  return on_plane(view, view->forward, view->right, view->up, x, y);
}

/// Where the ray through (x, y) and the lens' middle starts.
DS_FN real3 camera_start(const ViewData* view, real x, real y) {
  return on_plane(view, view->start, view->start_right, view->start_up, x, y);
}

#ifdef DS_LENS
DS_FN real3 on_lens(const float* right, const float* up, real2 d) {
  return vec(fma(d.x, (real)(right[0]), d.y * up[0]), fma(d.x, (real)(right[1]), d.y * up[1]),
             fma(d.x, (real)(right[2]), d.y * up[2]));
}

DS_FN CameraRay camera_ray(const ViewData* view, real x, real y, real2 lens) {
  const real2 d = concentric_disc(lens);
  const real3 offset = on_lens(view->lens_right, view->lens_up, d);
  CameraRay r;
  r.origin = add(camera_start(view, x, y), on_lens(view->start_lens_right, view->start_lens_up, d));
  // Towards the point in focus, over the focus distance: a lens of radius 0 gives the pinhole's
  // very bits.
  r.direction =
      unit(sub(camera_direction(view, x, y), scale(offset, (real)(1.0f / view->focus_distance))));
  return r;
}
#else
DS_FN CameraRay camera_ray(const ViewData* view, real x, real y, real2 lens) {
  CameraRay r;
  r.origin = camera_start(view, x, y);
  r.direction = unit(camera_direction(view, x, y));
  return r;
}
#endif

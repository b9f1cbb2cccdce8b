// SPDX-License-Identifier: Apache-2.0
// What every plane of a picture (arbitrary output variable, AOV) that asks no light answers: one ray
// a pixel, through its centre and the pinhole. A plane NAME in planes/NAME.h has
//
//   NAME_width    numbers a pixel
//   DS_TRAITS(NAME, sum)   of plane_traits.h
//   void NAME_at(const HitPoint* h, real* out)   the numbers where something was met; else all are 0
//
// The first paragraph of the header's comment is the plane's convention, in the reference and in
// every manifest.
#pragma once

#include "tracer/kernels/surface.h"

/// Object id of the model.
#define k_model_object 1u

typedef struct {
  real depth;           ///< metres along the viewing axis
  real distance;        ///< metres from the camera
  natural object;       ///< object id
  natural material_id;  ///< id of the material
  Surface surface;
#ifdef DS_HOOK_ALBEDO
  real3 albedo;  ///< surface_albedo of albedo.h
#endif
} HitPoint;

DS_FN void put_plane3(real* out, real3 v) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

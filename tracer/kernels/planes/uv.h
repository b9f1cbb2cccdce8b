// SPDX-License-Identifier: Apache-2.0
// The mesh's u and v as its file has them (EXR: R and G, B being 0), 0, 0 where nothing is hit or the mesh has none.
#pragma once

#include "tracer/kernels/plane.h"

enum { uv_width = 2 };
DS_TRAITS(uv, k_plane_surface | k_plane_uvs | k_plane_exr);

DS_FN void uv_at(const HitPoint* h, real* out) {
  out[0] = h->surface.u;
  out[1] = h->surface.v;
}

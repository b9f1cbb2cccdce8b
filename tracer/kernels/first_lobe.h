// SPDX-License-Identifier: Apache-2.0
// By which lobes a surface sends light on, for planes of light.
#pragma once

#include "tracer/kernels/contribution.h"
#include "tracer/kernels/leaving.h"

/// The part of evaluate_material's value that is of diffuse lobes.
DS_FN real3 diffuse_value(const MaterialPoint* m, Viewer viewer, real3 wi) {
  real3 result = splat((real)(0.0f));
#define DS_DIFFUSE(name, number)                                                              \
  {                                                                                           \
    const mask here = m->type == (uint)number;                                                \
    if (any_lane(here)) result = choose(here, name##_diffuse(m->inputs, viewer, wi), result); \
  }
  DS_MATERIALS(DS_DIFFUSE)
  return result;
}

/// 0 where nothing is sent on.
DS_FN real share_of(real part, real whole) {
  return lesser(part / greater(whole, (real)(1e-30f)), (real)(1.0f));
}

/// What share of leaving_value along `wi` (local) is of diffuse lobes, by colour.
DS_FN real3 diffuse_share(const MaterialPoint* m, const Leaving* l, real3 wi, mask active) {
  const real side = dot(wi, l->normal);
  real3 diffuse = splat((real)(0.0f)), all = splat((real)(0.0f));
  for (int i = 0; i < 2; ++i) {
    const mask counts = active & (side * wi.z > 0.0f);
    if (any_lane(counts)) {
      diffuse = choose(counts, add(diffuse, diffuse_value(m, l->viewer, wi)), diffuse);
      all = choose(counts, add(all, evaluate_material(m, l->viewer, wi).value), all);
    }
    wi = mirror_image(wi, l->normal);
  }
  return vec(share_of(diffuse.x, all.x), share_of(diffuse.y, all.y), share_of(diffuse.z, all.z));
}

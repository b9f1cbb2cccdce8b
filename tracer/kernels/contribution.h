// SPDX-License-Identifier: Apache-2.0
// What a plane of light (arbitrary output variable, AOV) is asked of all light that reaches the
// camera. Such a plane NAME in planes/NAME.h has
//
//   NAME_width = 3   linear red, green and blue
//   DS_TRAITS(NAME, k_plane_light | ...)
//   real3 NAME_takes(const Contribution* c)   what part of the light the plane holds, by colour
//
// and so is a share of the picture, of the same samples through the same filter.
#pragma once

#include "tracer/kernels/vec.h"

/// Light by its way back from the camera.
typedef struct {
  natural scatterings;  ///< surfaces on its way; none where the camera looks into what shines
  mask specular;        ///< a Dirac lobe of the first one sent it on
  real3 diffuse;        ///< else: what share of it the first one's diffuse lobes sent on, the rest
      ///< being of glossy lobes. It depends on the direction alone, not on how that
      ///< was sampled
  mask beyond;  ///< the camera looks right into what lies infinitely far
} Contribution;

/// Light that the first surface gets right from what shines, but for that in a mirror or through
/// glass.
DS_FN mask is_direct(const Contribution* c) {
  return (c->scatterings == 1u) & !c->specular;
}
DS_FN mask is_indirect(const Contribution* c) {
  return (c->scatterings > 1u) & !c->specular;
}

DS_FN real3 diffuse_part(mask takes, const Contribution* c) {
  return choose(takes, c->diffuse, splat((real)(0.0f)));
}
DS_FN real3 glossy_part(mask takes, const Contribution* c) {
  return choose(takes, sub(splat((real)(1.0f)), c->diffuse), splat((real)(0.0f)));
}
DS_FN real3 all_of(mask takes) {
  return choose(takes, splat((real)(1.0f)), splat((real)(0.0f)));
}

// SPDX-License-Identifier: Apache-2.0
// What every material answers. Directions are unit, in the local frame whose z axis is the shading
// normal on the side of the viewer; they point away from the surface. A material NAME in
// materials/NAME.h has
//
//   DS_NAME_INPUTS(INPUT)    its inputs: INPUT(slot, width, default), slot being NAME_input
//   DS_NAME_NUMBERS(NUMBER)  its fixed numbers: NUMBER(slot, default)
//   DS_TRAITS(NAME, sum)     of traits.h
//   NodeOnHost NAME_on_host  of traits.h, in a DS_HOOK_HOST part: what each input and number is, in which
//                            range, and what the material promises; tests hold it over all of the range
//   NAME_children            how many materials it chooses among; one with any has NAME_child alone
//   NAME_derived             how many numbers it derives from the inputs and the viewer, once for
//                            all questions; k_most_derived at most
//   void       NAME_prepare(const real* p, Viewer viewer, real* derived)
//   BsdfValue  NAME_evaluate(const real* p, Viewer viewer, real3 wi)
//   BsdfSample NAME_sample(const real* p, Viewer viewer, real2 u, real2 lobe)
//   natural    NAME_child(const real* p, mask outside, mask here, real* choice)
//   real3      NAME_albedo(const real* p, Viewer viewer)   share of the light falling along the normal
//                            that is sent on, up or down; the viewer is there
//   real       NAME_second(const real* p, mask outside)    of one that chooses: odds of the second child
//   real3      NAME_diffuse(const real* p, Viewer viewer, real3 wi)   the part of NAME_evaluate's value
//                            that counts as diffuse; the rest is glossy
//
// The last stands behind `#ifdef DS_HOOK_LIGHT_PLANES`, the two before behind `#ifdef DS_HOOK_ALBEDO`:
// they are in no program that does not ask for them, nor in its key.
//
// `p` holds the inputs' values at the surface point, behind them the numbers, and from NAME_end on
// what was derived. No material returns NaN or a negative number for any input in range.
#pragma once

#include "tracer/kernels/sampler.h"

enum { k_most_derived = 16 };

/// Turns an input list into word offsets: each slot's number is the sum of the widths before it.
#define DS_SLOT(slot, width, default_value) slot, slot##_last = slot + width - 1,
#define DS_NUMBER_SLOT(slot, default_value) slot,

typedef struct {
  real3 wo;      ///< to the viewer; wo.z > 0
  mask outside;  ///< the viewer is on the side the geometric normal points to
} Viewer;

typedef struct {
  real3 value;  ///< BSDF times |cos of wi|
  real pdf;     ///< of sampling wi, per steradian
} BsdfValue;

typedef struct {
  real3 wi;
  real3 weight;    ///< BSDF |cos| / pdf
  real pdf;        ///< per steradian; 0 for a specular sample
  real eta_scale;  ///< radiance scale of a refraction, (n_i / n_t)^2; 1 otherwise
  mask valid;
  mask specular;  ///< a Dirac lobe: no other strategy can find it
  mask glossy;    ///< counts as glossy, otherwise (and not specular) as diffuse
} BsdfSample;

DS_FN BsdfValue no_value(void) {
  BsdfValue v;
  v.value = splat((real)(0.0f));
  v.pdf = (real)(0.0f);
  return v;
}

DS_FN BsdfSample no_sample(void) {
  BsdfSample s;
  s.wi = vec((real)(0.0f), (real)(0.0f), (real)(1.0f));
  s.weight = splat((real)(0.0f));
  s.pdf = (real)(0.0f);
  s.eta_scale = (real)(1.0f);
  s.valid = (mask)(0);
  s.specular = (mask)(0);
  s.glossy = (mask)(0);
  return s;
}

/// Everything a mask can say yes to.
DS_FN mask all_lanes(void) {
  return (real)(0.0f) == (real)(0.0f);
}

DS_FN real3 input3(const real* p, int slot) {
  return vec(p[slot], p[slot + 1], p[slot + 2]);
}
DS_FN void put3(real* p, int slot, real3 v) {
  p[slot] = v.x;
  p[slot + 1] = v.y;
  p[slot + 2] = v.z;
}

/// Malley's method: cosine-weighted hemisphere, pdf cos / pi.
DS_FN real3 cosine_hemisphere(real2 u) {
  const real2 d = concentric_disc(u);
  // At least 1e-4, so that no direction lies in the surface.
  return vec(d.x, d.y, greater(safe_sqrt(1.0f - d.x * d.x - d.y * d.y), (real)(1e-4f)));
}

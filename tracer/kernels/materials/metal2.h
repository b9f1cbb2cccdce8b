// SPDX-License-Identifier: Apache-2.0
// A rough conductor: GGX microfacets with the exact Fresnel reflectance of n + ik for each of r, g,
// b.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_METAL2_INPUTS(INPUT)     \
  INPUT(metal2_n, 3, 0.5f)          \
  INPUT(metal2_k, 3, 0.5f)          \
  INPUT(metal2_uroughness, 1, 0.1f) \
  INPUT(metal2_vroughness, 1, 0.1f)
#define DS_METAL2_NUMBERS(NUMBER)
enum { DS_METAL2_INPUTS(DS_SLOT) metal2_end };

DS_FN real3 metal2_fresnel(const real* p, real cosine) {
  const real c = clamp01(cosine);
  return vec(conductor_fresnel(p[metal2_n], p[metal2_k], c),
             conductor_fresnel(p[metal2_n + 1], p[metal2_k + 1], c),
             conductor_fresnel(p[metal2_n + 2], p[metal2_k + 2], c));
}

DS_FN BsdfValue metal2_evaluate(const real* p, Viewer viewer, real3 wi) {
  const Roughness r = roughness_of(p[metal2_uroughness], p[metal2_vroughness]);
  const mask above = wi.z > 0.0f;
  const real3 safe_wi = choose(above, wi, viewer.wo);
  const real3 h = half_vector(viewer.wo, safe_wi);
  const Lobe lobe = ggx_lobe(r, viewer.wo, safe_wi, h);
  BsdfValue v;
  v.value = scale(metal2_fresnel(p, dot(viewer.wo, h)), choose(above, lobe.specular, (real)(0.0f)));
  v.pdf = choose(above, lobe.pdf, (real)(0.0f));
  return v;
}

DS_FN BsdfSample metal2_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const Roughness r = roughness_of(p[metal2_uroughness], p[metal2_vroughness]);
  const real3 h = ggx_visible_normal(r, viewer.wo, u);
  BsdfSample s = no_sample();
  s.wi = reflect_about(viewer.wo, h);
  s.valid = s.wi.z > 0.0f;
  const real3 safe_wi = choose(s.valid, s.wi, viewer.wo);
  const Lobe l = ggx_lobe(r, viewer.wo, safe_wi, h);
  s.weight = scale(metal2_fresnel(p, dot(viewer.wo, h)), l.specular / l.pdf);
  s.pdf = l.pdf;
  s.glossy = all_lanes();
  return s;
}

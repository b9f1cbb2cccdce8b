// SPDX-License-Identifier: Apache-2.0
// A matte base kd under a rough dielectric coat of reflectance ks at normal incidence (or of
// refractive index `index` where that is not 0), with absorption ka over depth d in the coat. On
// both sides.
//
// The coat is GGX with Schlick's Fresnel. What it lets through both ways lights the base:
//   f = D G2 F(h) / (4 cos_o cos_i) + kd / pi (1 - F(o)) (1 - F(i)) exp(-ka d (1 / cos_o + 1 /
//   cos_i))
// which is reciprocal and never above 1 in sum. LuxCore weighs the base by 1 - F(h) instead, which
// gains energy at grazing.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_GLOSSY2_INPUTS(INPUT)     \
  INPUT(glossy2_kd, 3, 0.5f)         \
  INPUT(glossy2_ks, 3, 0.5f)         \
  INPUT(glossy2_uroughness, 1, 0.1f) \
  INPUT(glossy2_vroughness, 1, 0.1f) \
  INPUT(glossy2_ka, 3, 0.0f)         \
  INPUT(glossy2_d, 1, 0.0f)          \
  INPUT(glossy2_index, 1, 0.0f)
#define DS_GLOSSY2_NUMBERS(NUMBER)  \
  NUMBER(glossy2_multibounce, 0.0f) \
  NUMBER(glossy2_doublesided, 0.0f)
enum { DS_GLOSSY2_INPUTS(DS_SLOT) glossy2_end };

DS_FN real3 glossy2_normal_reflectance(const real* p) {
  const real index = p[glossy2_index];
  const real r = (index - 1.0f) / (index + 1.0f);
  return choose(index > 0.0f, splat(r * r), input3(p, glossy2_ks));
}

DS_FN real glossy2_absorption(real absorption, real path) {
  return exponential(-absorption * path);
}

/// Base times cosine of wi.
DS_FN real3 glossy2_base(const real* p, real3 ks, real3 wo, real3 wi) {
  const real3 one = splat((real)(1.0f));
  const real3 passed =
      mul(sub(one, schlick_fresnel(ks, wo.z)), sub(one, schlick_fresnel(ks, wi.z)));
  const real3 base = scale(mul(input3(p, glossy2_kd), passed), wi.z * DS_INV_PI);
  if (!any_lane(p[glossy2_d] > 0.0f)) return base;
  const real path =
      p[glossy2_d] * (1.0f / greater(wo.z, (real)(1e-4f)) + 1.0f / greater(wi.z, (real)(1e-4f)));
  const real3 ka = input3(p, glossy2_ka);
  return mul(base, vec(glossy2_absorption(ka.x, path), glossy2_absorption(ka.y, path),
                       glossy2_absorption(ka.z, path)));
}

/// Probability of sampling the coat: its share of what is reflected, as seen from wo.
DS_FN real glossy2_coat_probability(const real* p, real3 ks, real3 wo) {
  const real coat = luminance(schlick_fresnel(ks, wo.z));
  const real base = luminance(input3(p, glossy2_kd)) * (1.0f - coat);
  const real sum = coat + base;
  return choose(sum > 0.0f, greater(coat, (real)(1e-10f)) / greater(sum, (real)(1e-10f)),
                (real)(0.5f));
}

/// Both lobes at wi, which is above the surface.
DS_FN BsdfValue glossy2_both(const real* p, real3 wo, real3 wi) {
  const Roughness r = roughness_of(p[glossy2_uroughness], p[glossy2_vroughness]);
  const real3 ks = glossy2_normal_reflectance(p);
  const real3 h = half_vector(wo, wi);
  const Lobe lobe = ggx_lobe(r, wo, wi, h);
  const real coat = glossy2_coat_probability(p, ks, wo);
  BsdfValue v;
  v.value = add_scaled(glossy2_base(p, ks, wo, wi), schlick_fresnel(ks, dot(wo, h)), lobe.specular);
  v.pdf = coat * lobe.pdf + (1.0f - coat) * wi.z * DS_INV_PI;
  return v;
}

DS_FN BsdfValue glossy2_evaluate(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  BsdfValue v = glossy2_both(p, viewer.wo, choose(above, wi, viewer.wo));
  v.value = choose(above, v.value, splat((real)(0.0f)));
  v.pdf = choose(above, v.pdf, (real)(0.0f));
  return v;
}

DS_FN BsdfSample glossy2_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const Roughness r = roughness_of(p[glossy2_uroughness], p[glossy2_vroughness]);
  const real3 ks = glossy2_normal_reflectance(p);
  BsdfSample s = no_sample();
  s.glossy = lobe.x < glossy2_coat_probability(p, ks, viewer.wo);
  const real3 mirrored = reflect_about(viewer.wo, ggx_visible_normal(r, viewer.wo, u));
  s.wi = choose(s.glossy, mirrored, cosine_hemisphere(u));
  s.valid = s.wi.z > 0.0f;
  const BsdfValue v = glossy2_both(p, viewer.wo, choose(s.valid, s.wi, viewer.wo));
  s.pdf = v.pdf;
  s.weight = scale(v.value, 1.0f / greater(v.pdf, (real)(1e-20f)));
  return s;
}

// SPDX-License-Identifier: Apache-2.0
// Cloth with a nap: what a layer of thin fibres scatters once (Koenderink and Pont 2003, "The secret of
// velvety skin"), bright where light or eye graze it. The light that turns by an angle of cosine c is
// 1 + p1 c + p2 (3 c^2 - 1) / 2 + p3 (5 c^3 - 3 c) / 2, or 0 where that is less. Where both make a
// greater cosine with the normal than thickness times the mean of that, w, the value is LuxCore's;
// where one makes a smaller, LuxCore's would give back more than came, and this one goes evenly to 0.
//
// With P that polynomial, t = thickness w, and C the lesser of t, cos_o and cos_i:
//   f = kd P / (4 pi w) C / (cos_o cos_i)
// Reciprocal; P / (4 pi w) is a density over the sphere and C / cos_o is at most 1, so that no more is
// sent on than the share of the sphere above the surface. LuxCore has t for C and cuts f cos_i at 1.
#pragma once

#include "tracer/kernels/bsdf.h"

#define DS_VELVET_INPUTS(INPUT) \
  INPUT(velvet_kd, 3, 0.5f)     \
  INPUT(velvet_p1, 1, -2.0f)    \
  INPUT(velvet_p2, 1, 20.0f)    \
  INPUT(velvet_p3, 1, 2.0f)     \
  INPUT(velvet_thickness, 1, 0.1f)
#define DS_VELVET_NUMBERS(NUMBER)
enum { DS_VELVET_INPUTS(DS_SLOT) DS_VELVET_NUMBERS(DS_NUMBER_SLOT) velvet_end };
enum { velvet_mean, velvet_derived };
enum { velvet_children = 0 };
DS_TRAITS(velvet, k_trait_receives_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter velvet_parameters[] = {
    {"kd", "what is sent on", k_not_negative, ParameterKind::share},
    {"p1", "of the angle by which light turns: weight of its cosine"},
    {"p2", "weight of the second Legendre polynomial of the cosine"},
    {"p3", "weight of the third"},
    {"thickness", "of the layer: its optical depth along the normal", k_not_negative}};
inline constexpr NodeOnHost velvet_on_host{.parameters = velvet_parameters, .albedo_error = 0.02};
#endif

/// Of the numbers a texture may give, those beyond this would overflow.
DS_FN real velvet_held(real x) {
  return greater(lesser(x, (real)(1e6f)), (real)(-1e6f));
}

/// P of c in [-1, 1].
DS_FN real velvet_phase(const real* p, real c) {
  const real p1 = velvet_held(p[velvet_p1]);
  const real p2 = velvet_held(p[velvet_p2]);
  const real p3 = velvet_held(p[velvet_p3]);
  const real even = fma(p2, fma(c * c, (real)(1.5f), (real)(-0.5f)), (real)(1.0f));
  const real odd = fma(p3, fma(c * c, (real)(2.5f), (real)(-1.5f)), p1);
  return greater(fma(odd, c, even), (real)(0.0f));
}

/// Nodes of the midpoint rule on [0, 1], by which the mean over the sphere is good to 1 %.
enum { k_velvet_nodes = 16 };
DS_FN real velvet_node(int i) {
  return ((float)i + 0.5f) * (1.0f / (float)k_velvet_nodes);
}

/// Without the cut at 0 the mean is 1, so it is never less.
DS_FN void velvet_prepare(const real* p, Viewer viewer, real* derived) {
  real sum = (real)(0.0f);
  for (int i = 0; i < k_velvet_nodes; ++i)
    sum += velvet_phase(p, velvet_node(i)) + velvet_phase(p, -velvet_node(i));
  derived[velvet_mean] = greater(sum * (0.5f / (float)k_velvet_nodes), (real)(1.0f));
}

/// P / w times the lesser of thickness w and a cosine.
DS_FN real velvet_scattered(const real* p, real c, real cosine) {
  const real mean = (p + velvet_end)[velvet_mean];
  const real thickness = greater(p[velvet_thickness], (real)(0.0f));
  return velvet_phase(p, c) / mean * lesser(thickness * mean, cosine);
}

/// wi is above the surface.
DS_FN real3 velvet_value(const real* p, real3 wo, real3 wi) {
  const real lower = lesser(wo.z, wi.z);
  return scale(input3(p, velvet_kd),
               velvet_scattered(p, -dot(wo, wi), lower) / wo.z * (0.25f * DS_INV_PI));
}

DS_FN BsdfValue velvet_evaluate(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  BsdfValue v = no_value();
  v.value = choose(above, velvet_value(p, viewer.wo, choose(above, wi, viewer.wo)), v.value);
  v.pdf = choose(above, (real)(DS_INV_TWO_PI), v.pdf);
  return v;
}

/// Evenly over the hemisphere: value over pdf is then at most kd P / (2 w).
DS_FN BsdfSample velvet_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const real2 d = concentric_disc(u);
  const real r2 = fma(d.x, d.x, d.y * d.y);
  const real height = greater(1.0f - r2, (real)(1e-4f));
  // sin over the square root of r2; of the height as it is held, so that wi stays unit.
  const real across = safe_sqrt((1.0f - height * height) / greater(r2, (real)(1e-20f)));
  BsdfSample s = no_sample();
  s.wi = vec(d.x * across, d.y * across, height);
  s.pdf = (real)(DS_INV_TWO_PI);
  s.weight = scale(velvet_value(p, viewer.wo, s.wi), (real)(2.0f * DS_PI));
  s.valid = all_lanes();
  return s;
}

#ifdef DS_HOOK_ALBEDO
DS_FN real3 velvet_albedo(const real* p, Viewer viewer) {
  real sum = (real)(0.0f);
  for (int i = 0; i < k_velvet_nodes; ++i)
    sum += velvet_scattered(p, -velvet_node(i), velvet_node(i));
  return scale(input3(p, velvet_kd), sum * (0.5f / (float)k_velvet_nodes));
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 velvet_diffuse(const real* p, Viewer viewer, real3 wi) {
  return velvet_evaluate(p, viewer, wi).value;
}
#endif

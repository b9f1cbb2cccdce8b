// SPDX-License-Identifier: Apache-2.0
// Disney's principled surface (Burley 2012, "Physically Based Shading at Disney", course notes of SIGGRAPH): one
// colour, and how it is sent on by numbers from 0 to 1. As LuxCore has it: of `roughness` the diffuse part takes the
// square, `clearcoat` at 1 is a whole coat and not a quarter of one, and a tint is the colour over 0.3 r + 0.6 g + b.
// What a texture gives is held in [0, 1]. Where the parts together would give back more than came, all of them are
// scaled, alike for both directions. Both sides are alike; LuxCore's is black from behind, and has the cosine of the light twice. `anisotropic` stretches
// highlights along an axis made of the normal; in LuxCore it is the mesh's uv that says.
//
// With L the cosine of light to half vector, w(c) = (1 - c)^5, b the base colour and m `metallic`:
//   f0 = (1 - m) b / pi (1 + (0.5 + 2 L^2 roughness^2 - 1) w(o)) (the same of i)          the diffuse part, or
//        (1 - m) b / pi 1.25 (F (1 / (cos_o + cos_i) - 0.5) + 0.5), F as above with L^2 roughness - 1
//                                                                                        mixed by `subsurface`
//        + (1 - m) sheen w(L) tinted + D2 G F / (4 cos_o cos_i) + clearcoat D1 G F / (4 cos_o cos_i)
// D2 being GGX of alpha = roughness^2, D1 "GTR1" of alpha from 0.1 to 0.001 by `clearcoatgloss`, G the product of both
// ways' shadowing (for the coat of alpha 0.25), F Schlick's from 0.08 specular, the base colour or 0.04. With A(w) no
// less than the albedo of f0 seen from w (closed forms and fits below):
//   f = f0 / max(1, A(o), A(i))
// which is reciprocal, and sends on no more than comes.
#pragma once

#include "tracer/kernels/microfacet.h"

#define DS_DISNEY_INPUTS(INPUT)         \
  INPUT(disney_basecolor, 3, 0.5f)      \
  INPUT(disney_subsurface, 1, 0.0f)     \
  INPUT(disney_roughness, 1, 0.0f)      \
  INPUT(disney_metallic, 1, 0.0f)       \
  INPUT(disney_specular, 1, 0.0f)       \
  INPUT(disney_speculartint, 1, 0.0f)   \
  INPUT(disney_clearcoat, 1, 0.0f)      \
  INPUT(disney_clearcoatgloss, 1, 0.0f) \
  INPUT(disney_anisotropic, 1, 0.0f)    \
  INPUT(disney_sheen, 1, 0.0f)          \
  INPUT(disney_sheentint, 1, 0.0f)
#define DS_DISNEY_NUMBERS(NUMBER)
enum { DS_DISNEY_INPUTS(DS_SLOT) DS_DISNEY_NUMBERS(DS_NUMBER_SLOT) disney_end };
enum { disney_children = 0 };
DS_TRAITS(disney, k_trait_lobes | k_trait_casts_caustics | k_trait_receives_caustics);
#ifdef DS_HOOK_HOST
inline constexpr Parameter disney_parameters[] = {
    {"basecolor", "colour of the diffuse part, and of the metal's reflection", k_zero_to_one,
     ParameterKind::share},
    {"subsurface", "0: diffuse as a rough surface is; 1: flat, as light from below it",
     k_zero_to_one},
    {"roughness", "alpha of GGX is its square", k_zero_to_one},
    {"metallic", "0: a dielectric; 1: a metal, without a diffuse part", k_zero_to_one},
    {"specular", "reflectance at normal incidence over 0.08", k_zero_to_one},
    {"speculartint", "of the reflection towards the colour", k_zero_to_one},
    {"clearcoat", "weight of a second, colourless reflection", k_zero_to_one},
    {"clearcoatgloss", "0: that is as satin; 1: sharp", k_zero_to_one},
    {"anisotropic", "0: highlights are round; 1: long along an axis", k_zero_to_one},
    {"sheen", "more light at grazing, as of cloth", k_zero_to_one},
    {"sheentint", "of that towards the colour", k_zero_to_one}};
inline constexpr NodeOnHost disney_on_host{.parameters = disney_parameters, .albedo_error = 0.02};
#endif
enum {
  disney_alpha_x,
  disney_alpha_y,
  disney_at_normal,                    ///< 3: reflectance of the facets at normal incidence
  disney_base = disney_at_normal + 3,  ///< 3: (1 - m) b
  disney_fuzz = disney_base + 3,       ///< 3: (1 - m) sheen tinted
  disney_coat_alpha2 = disney_fuzz + 3,
  disney_coat_log,  ///< -ln of that
  disney_excess,    ///< the greater of 1 and A(o)
  disney_p_facets,  ///< probability of sampling D2
  disney_p_coat,    ///< of sampling D1, behind it
  disney_derived
};

/// Schlick's w.
DS_FN real disney_grazing(real cosine) {
  return power5(clamp01(1.0f - cosine));
}

/// Albedo of the diffuse part over b: its integral in closed form. Over the azimuth, 2 L^2 - 1 =
/// dot(o, i) is a cosine about a mean; over the height what is left are moments of (1 - c)^5.
DS_FN real disney_diffuse_albedo(real r2, real cosine) {
  const real a = r2 - 0.5f;
  const real b = r2 * cosine;
  const real around = 0.5f * r2 * r2 * (1.0f - cosine * cosine) * (1.0f / 21.0f - 1.0f / 252.0f);
  const real once = fma(a, (real)(1.0f / 21.0f), b * (1.0f / 84.0f));
  const real twice =
      fma(a * a, (real)(1.0f / 21.0f), fma(a * b, (real)(1.0f / 42.0f), b * b * (1.0f / 252.0f)));
  return 1.0f + once + disney_grazing(cosine) * (fma(b, (real)(2.0f / 3.0f), a) + twice + around);
}

/// That of `subsurface` over b. A fit of our own to the integral by quadrature: never below it, above
/// it by at most 0.06 (0.01 where the cosine is above 0.3).
DS_FN real disney_subsurface_albedo(real roughness, real cosine) {
  const real w = disney_grazing(cosine);
  const real smooth = fma(cosine, fma(cosine, (real)(0.5145f), (real)(-1.4124f)), (real)(1.6515f)) -
                      w * fma(w, (real)(0.6923f), (real)(0.3298f));
  const real rough = fma(w, fma(w, (real)(0.4621f), (real)(0.3762f)),
                         fma(cosine, (real)(-0.036f), (real)(0.0475f)));
  return fma(roughness, rough, smooth);
}

/// That of w(L), and that of the coat over `clearcoat` whatever its gloss: likewise, above them by at
/// most 0.0035 and (for cosines above 0.3) 0.04.
DS_FN real disney_fuzz_albedo(real cosine) {
  const real w = disney_grazing(cosine);
  return fma(w, fma(w, (real)(-0.032f), (real)(0.0926f)),
             fma(cosine, (real)(-0.0276f), (real)(0.028f)));
}
DS_FN real disney_coat_albedo(real cosine) {
  const real w = disney_grazing(cosine);
  return fma(w, fma(w, (real)(-0.2984f), (real)(0.4031f)),
             fma(cosine, (real)(-0.0521f), (real)(0.0898f)));
}

DS_FN Roughness disney_alphas(const real* derived) {
  Roughness r;
  r.x = derived[disney_alpha_x];
  r.y = derived[disney_alpha_y];
  return r;
}

/// What the parts send on of white light from this cosine, or somewhat more.
typedef struct {
  real3 base, facets;
  real coat;
} DisneyAlbedo;

DS_FN DisneyAlbedo disney_parts(const real* p, const real* derived, real cosine) {
  const real c = lesser(cosine, (real)(1.0f));
  const real roughness = clamp01(p[disney_roughness]);
  const real below = clamp01(p[disney_subsurface]);
  real diffuse = disney_diffuse_albedo(square(roughness), c);
  diffuse = fma(below, disney_subsurface_albedo(roughness, c) - diffuse, diffuse);
  const Roughness r = disney_alphas(derived);
  // Of unequal alphas the one that reflects more counts. The fit begins at 0.05: below, nothing is lost.
  const real alpha = lesser(r.x, r.y);
  const real lost = clamp01((alpha - 0.05f) * 20.0f) * ggx_lost(greater(alpha, (real)(0.05f)), c);
  const real white = greater(ggx_grazing_share(r.x, c), ggx_grazing_share(r.y, c));
  DisneyAlbedo a;
  a.base = add_scaled(scale(input3(derived, disney_base), diffuse), input3(derived, disney_fuzz),
                      disney_fuzz_albedo(c));
  a.facets = add_scaled(splat(white), input3(derived, disney_at_normal),
                        greater(1.0f - lost - white, (real)(0.0f)));
  a.coat = clamp01(p[disney_clearcoat]) * disney_coat_albedo(c);
  return a;
}

/// The greater of 1 and A.
DS_FN real disney_excess_of(DisneyAlbedo a) {
  return greater(max_component(add(a.base, a.facets)) + a.coat, (real)(1.0f));
}

DS_FN void disney_prepare(const real* p, Viewer viewer, real* derived) {
  const real3 given = input3(p, disney_basecolor);
  const real3 color = vec(clamp01(given.x), clamp01(given.y), clamp01(given.z));
  const real tinted = fma(color.x, (real)(0.3f), fma(color.y, (real)(0.6f), color.z));
  const real3 tint = choose(tinted > 0.0f, scale(color, 1.0f / greater(tinted, (real)(1e-20f))),
                            splat((real)(1.0f)));
  const real3 white = splat((real)(1.0f));
  const real metallic = clamp01(p[disney_metallic]);
  const real alpha = square(clamp01(p[disney_roughness]));
  const real aspect = sqrt(1.0f - 0.9f * clamp01(p[disney_anisotropic]));
  const Roughness r = roughness_of(alpha / aspect, alpha * aspect);
  derived[disney_alpha_x] = r.x;
  derived[disney_alpha_y] = r.y;
  const real3 dielectric = scale(lerp3(white, tint, clamp01(p[disney_speculartint])),
                                 0.08f * clamp01(p[disney_specular]));
  put3(derived, disney_at_normal, lerp3(dielectric, color, metallic));
  put3(derived, disney_base, scale(color, 1.0f - metallic));
  put3(derived, disney_fuzz,
       scale(lerp3(white, tint, clamp01(p[disney_sheentint])),
             (1.0f - metallic) * clamp01(p[disney_sheen])));
  const real coat_alpha = fma(clamp01(p[disney_clearcoatgloss]), (real)(-0.099f), (real)(0.1f));
  derived[disney_coat_alpha2] = square(coat_alpha);
  derived[disney_coat_log] = -2.0f * logarithm(coat_alpha);
  const DisneyAlbedo a = disney_parts(p, derived, viewer.wo.z);
  derived[disney_excess] = disney_excess_of(a);
  // Their albedo but roughly: the fit is rounded where it is near 0, and a pdf is asked where nothing else is left.
  const real f = luminance(input3(derived, disney_at_normal));
  const real grazing = disney_grazing(viewer.wo.z) * (1.0f - clamp01(p[disney_roughness]));
  const real facets = fma(1.0f - f, grazing, f) + 0.02f;
  const real share = 1.0f / (luminance(a.base) + facets + a.coat);
  derived[disney_p_facets] = facets * share;
  derived[disney_p_coat] = a.coat * share;
}

/// Times the cosine of wi, over the excess: what f0 is scaled by.
DS_FN real disney_scale(const real* p, real3 wi) {
  const real* derived = p + disney_end;
  return wi.z / greater(derived[disney_excess], disney_excess_of(disney_parts(p, derived, wi.z)));
}

/// The diffuse part of f0.
DS_FN real3 disney_spread(const real* p, real3 wo, real3 wi) {
  const real* derived = p + disney_end;
  const real roughness = clamp01(p[disney_roughness]);
  const real twice_l2 = greater(1.0f + dot(wo, wi), (real)(0.0f));
  const real w_o = disney_grazing(wo.z);
  const real w_i = disney_grazing(wi.z);
  const real retro = fma(twice_l2, square(roughness), (real)(-0.5f));
  const real flat = fma(twice_l2, 0.5f * roughness, (real)(-1.0f));
  const real diffuse = fma(retro, w_o, (real)(1.0f)) * fma(retro, w_i, (real)(1.0f));
  const real lit = fma(flat, w_o, (real)(1.0f)) * fma(flat, w_i, (real)(1.0f));
  const real below = 1.25f * fma(lit, 1.0f / (wo.z + wi.z) - 0.5f, (real)(0.5f));
  const real both = fma(clamp01(p[disney_subsurface]), below - diffuse, diffuse);
  const real fuzz = disney_grazing(safe_sqrt(0.5f * twice_l2));
  return add_scaled(scale(input3(derived, disney_base), both * DS_INV_PI),
                    input3(derived, disney_fuzz), fuzz);
}

/// GTR1, 1/sr.
DS_FN real disney_coat_distribution(const real* derived, real3 h) {
  const real a2 = derived[disney_coat_alpha2];
  const real t = fma(h.x, h.x, fma(h.y, h.y, a2 * square(h.z)));
  return (1.0f - a2) * DS_INV_PI / (derived[disney_coat_log] * t);
}

/// Smith's shadowing of alpha 0.25 over twice the cosine.
DS_FN real disney_coat_shadowing(real cosine) {
  return 1.0f / (cosine + sqrt(fma(cosine * cosine, (real)(0.9375f), (real)(0.0625f))));
}

/// Over the coat's distribution of normals.
DS_FN real disney_coat_part(const real* p, real w_l, real cos_o, real cos_i) {
  return clamp01(p[disney_clearcoat]) * fma(w_l, (real)(0.96f), (real)(0.04f)) *
         disney_coat_shadowing(cos_o) * disney_coat_shadowing(cos_i);
}

/// f0 times the scale, and the pdf; wi is above the surface.
DS_INLINED BsdfValue disney_all(const real* p, real3 wo, real3 wi) {
  const real* derived = p + disney_end;
  const real3 h = half_vector(wo, wi);
  const real l = dot(wo, h);
  const real w_l = disney_grazing(l);
  const Roughness r = disney_alphas(derived);
  const real d = ggx_distribution(r, h);
  const real lo = wo.z + stretched_length(r, wo);
  const real li = wi.z + stretched_length(r, wi);
  const real coat_d = disney_coat_distribution(derived, h);
  const real3 f = lerp3(input3(derived, disney_at_normal), splat((real)(1.0f)), w_l);
  const real coat = coat_d * disney_coat_part(p, w_l, wo.z, wi.z);
  BsdfValue v;
  v.value = add(add_scaled(disney_spread(p, wo, wi), f, d / (lo * li)), splat(coat));
  v.value = scale(v.value, disney_scale(p, wi));
  const real p_facets = derived[disney_p_facets];
  const real p_coat = derived[disney_p_coat];
  v.pdf = p_facets * d * 0.5f / lo + p_coat * coat_d * h.z * 0.25f / greater(l, (real)(1e-10f)) +
          greater(1.0f - p_facets - p_coat, (real)(0.0f)) * wi.z * DS_INV_PI;
  return v;
}

DS_FN BsdfValue disney_evaluate(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  BsdfValue v = disney_all(p, viewer.wo, choose(above, wi, viewer.wo));
  v.value = choose(above, v.value, splat((real)(0.0f)));
  v.pdf = choose(above, v.pdf, (real)(0.0f));
  return v;
}

/// A normal of the coat with pdf D1 h.z (Burley 2012, appendix B).
DS_FN real3 disney_coat_normal(const real* derived, real2 u) {
  const real a2 = derived[disney_coat_alpha2];
  const real x = exponential(-derived[disney_coat_log] * (1.0f - u.y));
  const real sine = safe_sqrt((x - a2) / (1.0f - a2));
  const SinCos phi = sin_cos_turns(u.x);
  return vec(sine * phi.cos, sine * phi.sin, safe_sqrt((1.0f - x) / (1.0f - a2)));
}

DS_FN BsdfSample disney_sample(const real* p, Viewer viewer, real2 u, real2 lobe) {
  const real* derived = p + disney_end;
  const real p_facets = derived[disney_p_facets];
  const mask facets = lobe.x < p_facets;
  BsdfSample s = no_sample();
  s.glossy = lobe.x < p_facets + derived[disney_p_coat];
  const real3 h = choose(facets, ggx_visible_normal(disney_alphas(derived), viewer.wo, u),
                         disney_coat_normal(derived, u));
  s.wi = choose(s.glossy, reflect_about(viewer.wo, h), cosine_hemisphere(u));
  s.valid = s.wi.z > 0.0f;
  const BsdfValue v = disney_all(p, viewer.wo, choose(s.valid, s.wi, viewer.wo));
  s.pdf = v.pdf;
  s.weight = scale(v.value, 1.0f / greater(v.pdf, (real)(1e-20f)));
  return s;
}

#ifdef DS_HOOK_ALBEDO
/// By so many directions of each part, spread as its light is.
enum { k_disney_nodes = 8 };

DS_FN real3 disney_albedo(const real* p, Viewer viewer) {
  const real* derived = p + disney_end;
  const real3 wo = vec((real)(0.0f), (real)(0.0f), (real)(1.0f));
  const real3 white = splat((real)(1.0f));
  const Roughness r = disney_alphas(derived);
  real3 sum = splat((real)(0.0f));
  for (int i = 0; i < k_disney_nodes; ++i) {
    const float u = ((float)i + 0.5f) / (float)k_disney_nodes;
    const real c = sqrt((real)(u));
    const real3 wi = vec(sqrt((real)(1.0f - u)), (real)(0.0f), c);
    sum = add_scaled(sum, disney_spread(p, wo, wi), disney_scale(p, wi) * DS_PI / c);
    real2 at;
    at.x = (real)(0.0f);
    at.y = (real)(u);
    const real3 coat_h = disney_coat_normal(derived, at);
    const real3 coat_wi = reflect_about(wo, coat_h);
    const real coat = disney_coat_part(p, disney_grazing(coat_h.z), wo.z, coat_wi.z);
    sum = add(sum, choose(coat_wi.z > 0.0f, splat(4.0f * coat * disney_scale(p, coat_wi)),
                          splat((real)(0.0f))));
    // A quarter of the azimuth is like the others: its middle halves.
    const float slope = sqrt(u / (1.0f - u));
    for (int k = 0; k < 2; ++k) {
      const float x = slope * (k == 0 ? 0.923879533f : 0.382683432f);
      const float y = slope * (k == 0 ? 0.382683432f : 0.923879533f);
      const real3 h = unit(vec(r.x * x, r.y * y, (real)(1.0f)));
      const real3 facet_wi = reflect_about(wo, h);
      const real3 f = lerp3(input3(derived, disney_at_normal), white, disney_grazing(h.z));
      const real once = disney_scale(p, facet_wi) / (facet_wi.z + stretched_length(r, facet_wi));
      sum = choose(facet_wi.z > 0.0f, add_scaled(sum, f, once), sum);
    }
  }
  return scale(sum, 1.0f / (float)k_disney_nodes);
}
#endif

#ifdef DS_HOOK_LIGHT_PLANES
DS_FN real3 disney_diffuse(const real* p, Viewer viewer, real3 wi) {
  const mask above = wi.z > 0.0f;
  const real3 safe_wi = choose(above, wi, viewer.wo);
  const real3 spread = scale(disney_spread(p, viewer.wo, safe_wi), disney_scale(p, safe_wi));
  return choose(above, spread, splat((real)(0.0f)));
}
#endif

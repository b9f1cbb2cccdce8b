// SPDX-License-Identifier: Apache-2.0
// How a path may leave a surface point: by its material's BSDF, and where that receives caustics by
// the guide as well.
//
// A lobe knows the shading normal alone. Where the true one is another, a part of what it sends up
// would go into the surface. Such directions are mirrored on the true plane: a lobe's light for a
// direction and for its mirror image, each as far as it is on the lobe's side of the shading
// normal, leaves together by the one on the true side. So none is lost and none is made, there is
// no dark rim where the shading normal's horizon lies above the true one's, and where both normals
// are one nothing changes.
#pragma once

#include "tracer/kernels/guide.h"
#include "tracer/kernels/shade.h"

typedef struct {
  Frame frame;   ///< around the shading normal
  real3 normal;  ///< the true one on the viewer's side, in that frame; unit
  Viewer viewer;
#ifdef DS_GUIDED
  Guide guide;
#endif
} Leaving;

/// Value and pdf of leaving by the BSDF along `wi` (local).
DS_FN BsdfValue leaving_value(const MaterialPoint* m, const Leaving* l, real3 wi, mask active) {
  const real side = dot(wi, l->normal);
  BsdfValue sum = no_value();
  for (int i = 0; i < 2; ++i) {
    const mask counts = active & (side * wi.z > 0.0f);
    if (any_lane(counts)) {
      const BsdfValue v = evaluate_material(m, l->viewer, wi);
      sum.value = choose(counts, add(sum.value, v.value), sum.value);
      sum.pdf = choose(counts, sum.pdf + v.pdf, sum.pdf);
    }
    wi = mirror_image(wi, l->normal);
  }
  return sum;
}

/// A direction that the material samples, mirrored where that lets it leave on its lobe's side.
/// Returns the lanes where that is the viewer's side.
DS_FN mask sample_leaving(const MaterialPoint* m, const Leaving* l, real2 u, real2 lobe,
                          mask active, BsdfSample* b) {
  *b = sample_material(m, l->viewer, u, lobe);
  const real3 image = mirror_image(b->wi, l->normal);
  const mask up = b->wi.z > 0.0f;
  const mask twice = active & b->valid & !b->specular & (b->wi.z * image.z > 0.0f);
  if (any_lane(twice)) {
    const BsdfValue v = evaluate_material(m, l->viewer, image);
    const real pdf = b->pdf + v.pdf;
    const real3 value = add(scale(b->weight, b->pdf), v.value);
    b->weight = choose(twice, scale(value, 1.0f / greater(pdf, (real)(1e-30f))), b->weight);
    b->pdf = choose(twice, pdf, b->pdf);
  }
  b->wi = choose(dot(b->wi, l->normal) * b->wi.z < 0.0f, image, b->wi);
  return up;
}

/// Density of a direction that the BSDF samples with this one.
DS_FN real leaving_pdf(const Leaving* l, real3 wi, real bsdf_pdf) {
#ifdef DS_GUIDED
  if (any_lane(l->guide.there)) {
    const real both =
        fma(guide_pdf(&l->guide, wi), (real)(k_guide_share), (1.0f - k_guide_share) * bsdf_pdf);
    return choose(l->guide.there, both, bsdf_pdf);
  }
#endif
  return bsdf_pdf;
}

#ifdef DS_GUIDED
/// Turns the samples of a share of the lanes towards the guide's spheres, and weighs all by the
/// density of both ways. `up`: as sample_leaving returned it.
DS_FN void guide_samples(BsdfSample* b, real3* wi, mask* up, const MaterialPoint* m,
                         const Leaving* l, mask active, real choice, real2 u) {
  const mask there = l->guide.there;
  const mask turned = there & (choice < k_guide_share);
  const real3 towards = guide_sample(&l->guide, choice * (1.0f / k_guide_share), u);
  const real3 turned_wi = to_local(l->frame, towards);
  const BsdfValue value = leaving_value(m, l, turned_wi, active & turned);
  const real3 f = choose(turned, value.value, scale(b->weight, b->pdf));
  const real bsdf_pdf = choose(turned, value.pdf, b->pdf);
  *wi = choose(turned, towards, *wi);
  *up = choose_mask(turned, dot(turned_wi, l->normal) > 0.0f, *up);
  const real pdf = leaving_pdf(l, *wi, bsdf_pdf);
  const mask dirac = b->specular & !turned;
  const real3 weight = choose(dirac, scale(b->weight, 1.0f / (1.0f - k_guide_share)),
                              scale(f, 1.0f / greater(pdf, (real)(1e-30f))));
  b->weight = choose(there, weight, b->weight);
  b->pdf = choose(there & !dirac, pdf, b->pdf);
  b->valid = choose_mask(turned, value.pdf > 0.0f, b->valid);
  b->specular = b->specular & !turned;
  b->glossy = b->glossy & !turned;
  b->eta_scale = choose(turned, (real)(1.0f), b->eta_scale);
}
#endif

// SPDX-License-Identifier: Apache-2.0
// How a path goes on from a surface, by its BSDF or along the guide, and whether roulette lets it;
// and what becomes of the light that its shadow ray was sent for.
#pragma once

#include "tracer/kernels/direct_light.cl"

/// True where a path may visit no further surface; what its last ray meets may still shine, which
/// the last vertex' light sample has left a share for.
DS_FN mask is_last(const Paths* paths, const ViewData* view) {
  return (paths->vertices >= view->depth_total) | (paths->diffuse > view->depth_diffuse) |
         (paths->glossy > view->depth_glossy) | (paths->specular > view->depth_specular);
}

/// Continues the paths by a BSDF sample, or along the guide; returns the lanes whose path ends
/// here.
DS_FN mask scatter(Paths* paths, mask active, const Surface* s, const MaterialPoint* m,
                   const Leaving* l, Sampler sampler, natural pair, real2 lobe, real roulette,
                   const ViewData* view) {
  const real guide_choice = lobe.y;
  lobe.y = (real)(0.0f);
  const real2 u = sample_pair(sampler, pair + (uint)k_pair_direction);
  BsdfSample b;
  mask up = sample_leaving(m, l, u, lobe, active, &b);
  real3 wi = to_world(l->frame, b.wi);
#ifdef DS_GUIDED
  if (any_lane(active & l->guide.there)) guide_samples(&b, &wi, &up, m, l, active, guide_choice, u);
#endif
  // Along the surface rounding may have taken a direction to the other side.
  const real true_side = dot(wi, s->normal);
  const mask leaks = choose(up, true_side, -true_side) <= 0.0f;
#ifdef DS_HOOK_LIGHT_PLANES
  paths->met.scatterings = paths->vertices;
  const mask first = active & (paths->vertices == 1u);
  if (any_lane(first)) {
    const real3 share = diffuse_share(m, l, to_local(l->frame, wi), first & !b.specular);
    paths->met.specular = choose_mask(first, b.specular, paths->met.specular);
    paths->met.diffuse = choose(first, share, paths->met.diffuse);
  }
#endif
  const real3 throughput = mul(paths->throughput, b.weight);
  const real eta_scale = paths->eta_scale * b.eta_scale;
  const mask plays = paths->vertices >= view->roulette_depth;
  const real survival =
      choose(plays,
             lesser(greater(max_component(throughput) / eta_scale, (real)(view->roulette_cap)),
                    (real)(1.0f)),
             (real)(1.0f));
  const mask matte = !(b.specular | b.glossy);
  paths->diffuse += choose_natural(matte, (natural)(1u), (natural)(0u));
  paths->glossy += choose_natural(b.glossy & !b.specular, (natural)(1u), (natural)(0u));
  paths->specular += choose_natural(b.specular, (natural)(1u), (natural)(0u));
  mask ends = !b.valid | leaks | (roulette >= survival) | (max_component(throughput) <= 0.0f);
#if !defined(DS_ESCAPE_LIGHTS) && !defined(DS_MESH_LIGHTS)
  // Nothing that a ray could meet shines.
  ends = ends | is_last(paths, view);
#endif
  paths->throughput = choose(active, scale(throughput, 1.0f / survival), paths->throughput);
  paths->eta_scale = choose(active, eta_scale, paths->eta_scale);
  paths->pdf = choose(active, choose(b.specular, (real)(-1.0f), b.pdf), paths->pdf);
  paths->origin =
      choose(active, offset_origin(s->position, s->error, s->normal, wi), paths->origin);
  paths->direction = choose(active, unit(wi), paths->direction);
  return active & ends;
}

/// Adds the light of shadow rays that met nothing, and the samples that waited for it.
DS_FN void add_direct(Paths* paths, Sums* sums, const BatchHits* found) {
  const mask lit = paths->shadow.wanted & (*(const mask*)found->any == 0);
  const real3 light = choose(lit, paths->direct, splat((real)(0.0f)));
  paths->radiance = choose(paths->closes, paths->radiance, add(paths->radiance, light));
  if (any_lane(paths->closes))
    add_samples(sums, paths->closes, paths->sample - 1u, paths->closing_quarter,
                add(paths->closing, light));
#ifdef DS_HOOK_LIGHT_PLANES
  contribute(&paths->closing_planes, paths->closes, &paths->asked, light);
  if (any_lane(paths->closes))
    add_light(&sums->light, paths->closes, paths->closing_quarter, sums->accepted,
              &paths->closing_planes);
  contribute(&paths->planes, lit & !paths->closes, &paths->asked, light);
#endif
  paths->closes = (mask)(0);
  paths->shadow.wanted = (mask)(0);
}

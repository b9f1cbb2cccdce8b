// SPDX-License-Identifier: Apache-2.0
// The paths of a work-item's lanes, and the light that a vertex sees directly: where paths start,
// what a hit emits, which light a shadow ray is sent to and what it would bring.
#pragma once

#include "tracer/kernels/batch.cl"
#include "tracer/kernels/camera.h"
#include "tracer/kernels/film.cl"
#include "tracer/kernels/hits.cl"
#include "tracer/kernels/leaving.h"
#include "tracer/kernels/ray_counts.h"
#include "tracer/kernels/tied_lanes.cl"
#ifdef DS_HOOK_LIGHT_PLANES
#  include "tracer/kernels/first_lobe.h"
#endif

/// Pairs of dimensions a sample uses: two for the camera, then k_pairs_vertex at each path vertex.
enum { k_pair_pixel, k_pair_lens, k_pairs_camera };
enum { k_pair_choices, k_pair_light, k_pair_direction, k_pair_lobe, k_pairs_vertex };

typedef struct {
  real3 origin, direction;
  real3 throughput, radiance;
  real pdf;  ///< of the BSDF sample that made this ray; -1: only this ray could find what it meets
  real eta_scale;    ///< product of refractions' radiance scales: roulette must not mistake it for
                     ///< loss
  natural vertices;  ///< surface points visited
  natural diffuse, glossy, specular;  ///< bounces of each sort
  natural sample;                     ///< number of the sample in flight
  natural quarter;                    ///< of its pixel that it is in
  natural layer;                      ///< triangle that the ray leaves to the next tied with it
                                      ///< (next_layer of ties.cl), or k_none
  mask rises;                         ///< to the next above it, not below
  mask alive;
  // The last vertex' light is known once its shadow ray is traced, together with the next ray of
  // the path, or with the first of the next sample where the path ended.
  LaneRays shadow;
  real3 direct;             ///< what the shadow ray's light adds where nothing stands between
  real3 closing;            ///< radiance so far of the sample before the one in flight
  natural closing_quarter;  ///< where that sample is in its pixel
  mask closes;              ///< it still waits for its shadow ray
#ifdef DS_HOOK_LIGHT_PLANES
  Contribution met, asked;            ///< what the path's ray and its shadow ray would bring
  PlaneLight planes, closing_planes;  ///< of `radiance` and of `closing`
#endif
  DS_RAY_COUNTS_FIELD
} Paths;

typedef struct {
  const __global float8* nodes;
  const __global float8* leaves;
  DS_GLOBAL float* triangles;
  MaterialTables materials;
  LightTables lights;
  DS_GLOBAL float* guide;
} SceneTables;

/// Starts the next sample in the lanes of `start`.
DS_FN void start_paths(Paths* paths, mask start, const Pixels* pixels, const ViewData* view) {
  const Sampler sampler =
      sampler_for(view->seed_low, view->seed_high, pixels->index, paths->sample);
  const real2 f = sample_pair(sampler, (natural)((uint)k_pair_pixel));
  real2 lens;
  lens.x = lens.y = (real)(0.0f);
#ifdef DS_LENS
  lens = sample_pair(sampler, (natural)((uint)k_pair_lens));
#endif
  const CameraRay ray = camera_ray(view, pixels->x + (f.x - 0.5f), pixels->y + (f.y - 0.5f), lens);
  const natural quarter = choose_natural(f.x < 0.5f, (natural)(0u), (natural)(1u)) +
                          choose_natural(f.y < 0.5f, (natural)(0u), (natural)(2u));
  paths->quarter = choose_natural(start, quarter, paths->quarter);
  const real zero = (real)(0.0f);
  const natural none = (natural)(0u);
  paths->origin = choose(start, ray.origin, paths->origin);
  paths->direction = choose(start, ray.direction, paths->direction);
  paths->throughput = choose(start, splat((real)(1.0f)), paths->throughput);
  paths->radiance = choose(start, splat(zero), paths->radiance);
  paths->pdf = choose(start, (real)(-1.0f), paths->pdf);
  paths->eta_scale = choose(start, (real)(1.0f), paths->eta_scale);
  paths->vertices = choose_natural(start, none, paths->vertices);
  paths->diffuse = choose_natural(start, none, paths->diffuse);
  paths->glossy = choose_natural(start, none, paths->glossy);
  paths->specular = choose_natural(start, none, paths->specular);
  paths->layer = choose_natural(start, (natural)(k_none), paths->layer);
  paths->alive = paths->alive | start;
#ifdef DS_HOOK_LIGHT_PLANES
  clear_light(&paths->planes, start);
  paths->met.scatterings = paths->vertices;
  paths->met.specular = paths->met.specular & !start;
  paths->met.beyond = paths->met.beyond & !start;
  paths->met.diffuse = choose(start, splat(zero), paths->met.diffuse);
#endif
}

#ifdef DS_MESH_LIGHTS
/// Radiance of an emitting triangle met by chance, weighed against having sampled it.
DS_FN real3 emitted(const SceneTables* t, const LaneHits* hits, const Surface* s, real3 origin,
                    real3 wo, mask hit, real pdf) {
  const natural light = bits_of(hit_word(hits, k_triangle_light));
  const mask emits = hit & (light != k_none) & s->outside;
  if (!any_lane(emits)) return splat((real)(0.0f));
  const natural at = choose_natural(emits, light, (natural)(0u)) * (uint)k_light_words;
  const real probability = load(t->lights.lights, at + (uint)k_light_probability);
  const real3 radiance = load3(t->lights.lights, at + (uint)(k_light_parameters + mesh_radiance));
  const real area = load(t->lights.lights, at + (uint)(k_light_parameters + mesh_area));
  const real3 way = sub(s->position, origin);
  const real cosine = greater(dot(s->normal, wo), (real)(1e-6f));
  const real light_pdf = probability * dot(way, way) / (cosine * area);
  const real weight = choose(pdf < 0.0f, (real)(1.0f), power_heuristic(pdf, light_pdf));
  return choose(emits, scale(radiance, weight), splat((real)(0.0f)));
}
#endif

#ifdef DS_LIGHTS_SAMPLED
/// A way to a light, and what would come of it.
typedef struct {
  real3 wi, target;  ///< as in LightSample
  mask bounded;
  natural covered;
  real3 direct;  ///< what it adds to the sample's radiance where nothing stands between
  real weight;   ///< 0: nothing comes this way
} Candidate;

DS_FN Candidate choose(mask m, Candidate a, Candidate b) {
  Candidate c;
  c.wi = choose(m, a.wi, b.wi);
  c.target = choose(m, a.target, b.target);
  c.bounded = choose_mask(m, a.bounded, b.bounded);
  c.covered = choose_natural(m, a.covered, b.covered);
  c.direct = choose(m, a.direct, b.direct);
  c.weight = choose(m, a.weight, b.weight);
  return c;
}

/// Share of choices among candidates that go by weight.
#  define k_by_weight 0.9f

DS_FN Candidate light_candidate(const LightSample* light, const Paths* paths, mask active,
                                const Surface* s, const MaterialPoint* m, const Leaving* l) {
  mask faces = dot(light->wi, s->normal) > 0.0f;
#  ifdef DS_TRANSMITS
  faces = faces | (DS_TRANSMITS(m->type) & (dot(light->wi, s->normal) < 0.0f));
#  endif
  faces = active & (light->pdf > 0.0f) & faces;
  const BsdfValue bsdf = leaving_value(m, l, to_local(l->frame, light->wi), faces);
  const real other = leaving_pdf(l, light->wi, bsdf.pdf);
  const real mis = choose(light->dirac, (real)(1.0f), power_heuristic(light->pdf, other));
  const real3 arriving = scale(light->radiance, mis / greater(light->pdf, (real)(1e-30f)));
  Candidate c;
  c.wi = light->wi;
  c.target = light->target;
  c.bounded = light->bounded;
  c.covered = light->covered;
  c.direct = mul(mul(paths->throughput, bsdf.value), arriving);
  const mask reaches = faces & (max_component(c.direct) > 0.0f);
  const real sum = c.direct.x + c.direct.y + c.direct.z;
  c.weight = choose(reaches, lesser(sum, (real)(1e30f)), (real)(0.0f));
  return c;
}

/// Next-event estimation: asks for a shadow ray and keeps what it would let through. Among several
/// candidates, one a light, one is chosen (resampled importance sampling, Talbot et al. 2005):
/// mostly in proportion to what it would add, so that little is asked of lights that are dim, far
/// or behind the surface; else by equal chances, so that a bright light that cannot be seen does
/// not hide the others. Measured: the shipped scenes' variance a sample falls by one to two thirds.
DS_FN void ask_for_light(Paths* paths, mask active, const Surface* s, const MaterialPoint* m,
                         const Leaving* l, Sampler sampler, natural pair, real choice,
                         const SceneData* scene, const SceneTables* t) {
  const real2 u = sample_pair(sampler, pair + (uint)k_pair_light);
  Candidate candidates[k_most_rounds];
  real sum = (real)(0.0f), count = (real)(0.0f);
  for (uint i = 0; i < scene->light_rounds; ++i) {
    const LightSample light = sample_light(t->lights, scene, i, active, s->position, choice, u);
    candidates[i] = light_candidate(&light, paths, active, s, m, l);
    sum = sum + candidates[i].weight;
    count = count + choose(candidates[i].weight > 0.0f, (real)(1.0f), (real)(0.0f));
  }
  Candidate chosen = candidates[0];
  if (scene->light_rounds > 1u) {
    const real per_weight = k_by_weight / sum;
    const real each = (1.0f - k_by_weight) / count;
    real low = (real)(0.0f), odds = (real)(1.0f);
    for (uint i = 0; i < scene->light_rounds; ++i) {
      const mask taken = (candidates[i].weight > 0.0f) & (low <= choice);
      const real own = fma(candidates[i].weight, per_weight, each);
      chosen = choose(taken, candidates[i], chosen);
      odds = choose(taken, own, odds);
      low = choose(candidates[i].weight > 0.0f, low + own, low);
    }
    chosen.direct = scale(chosen.direct, 1.0f / odds);
  }
  paths->direct = chosen.direct;
#  ifdef DS_HOOK_LIGHT_PLANES
  paths->asked = paths->met;
  paths->asked.scatterings = paths->vertices;
  const mask first = active & (paths->vertices == 1u);
  if (any_lane(first)) {
    const real3 share = diffuse_share(m, l, to_local(l->frame, chosen.wi), first);
    paths->asked.diffuse = choose(first, share, paths->asked.diffuse);
  }
#  endif
  LaneRays* shadow = &paths->shadow;
  shadow->wanted = sum > 0.0f;
  shadow->origin = offset_origin(s->position, s->error, s->normal, chosen.wi);
  const real3 way = sub(chosen.target, shadow->origin);
  const real distance = sqrt(greater(dot(way, way), (real)(1e-30f)));
  // Short of the light by 1e-4 of the way, so that an emitting surface does not shadow itself.
  shadow->direction = choose(chosen.bounded, scale(way, 1.0f / distance), chosen.wi);
  shadow->t_max = choose(chosen.bounded, distance * 0.9999f, (real)(1e30f));
#  ifdef DS_MESH_LIGHTS
  // Nor does the shadow ray reach what lies on the light.
  const mask covered = shadow->wanted & (chosen.covered != k_none);
  if (any_lane(covered))
    shadow->wanted = shadow->wanted & (next_layers(t->nodes, t->leaves, t->triangles, chosen.target,
                                                   chosen.covered, covered, covered) == k_none);
#  endif
}
#endif

// SPDX-License-Identifier: Apache-2.0
// The path tracer: unidirectional, next-event estimation, multiple importance sampling, Russian
// roulette. A work-item has a queue of pixels and traces DS_LANES of them at a time. A lane whose
// path has ended starts its pixel's next sample at once, and after the last takes the next pixel,
// so lanes stay busy; a pixel's samples are added in order by one lane, so the picture does not
// depend on how pixels are dealt out.
#include "tracer/kernels/path_ties.cl"
#include "tracer/kernels/scatter.cl"

/// How a step left the paths that it ended.
typedef struct {
  mask done;    ///< the sample is complete
  mask closes;  ///< but for its last shadow ray
} StepEnds;

/// One step of all paths: to the next surface, its light, its scattering. First adds the light that
/// was asked for before.
DS_FN StepEnds advance(Paths* paths, Sums* sums, const Pixels* pixels, const SceneData* scene,
                       const ViewData* view, const SceneTables* t) {
  StepEnds ends;
  ends.closes = (mask)(0);
  LaneRays next;
  next.origin = paths->origin;
  next.direction = paths->direction;
  next.t_max = (real)(1e30f);
  next.wanted = paths->alive;
  BatchHits found;
  DS_COUNT_STEP(paths);
  Ties ties;
  ties.inside = (mask)(0);
  ties.rises = paths->rises;
  natural layer = (natural)(k_none);
  if (any_lane(paths->alive & (paths->layer != k_none))) {
    layer = next_layers(t->nodes, t->leaves, t->triangles, paths->origin, paths->layer,
                        paths->rises, paths->alive & (paths->layer != k_none));
    ties.inside = layer != k_none;
    next.wanted = next.wanted & !ties.inside;
    paths->layer = (natural)(k_none);
  }
  ties.rises = ties.rises & ties.inside;
  trace_lanes(t->nodes, t->leaves, &next, &paths->shadow, &found);
  *(natural*)found.id = choose_natural(ties.inside, layer, *(const natural*)found.id);
  add_direct(paths, sums, &found);
  mask hit = paths->alive & (*(const natural*)found.id != k_none);
  const mask escapes = paths->alive & !hit;
  ends.done = escapes;
#ifdef DS_ESCAPE_LIGHTS
  if (any_lane(escapes)) {
    const real3 sky = escape_radiance(t->lights, scene->first_escape_light, scene->light_count,
                                      paths->direction, paths->pdf);
    paths->radiance =
        choose(escapes, add(paths->radiance, mul(paths->throughput, sky)), paths->radiance);
#  ifdef DS_HOOK_LIGHT_PLANES
    paths->met.beyond = escapes & (paths->met.scatterings == 0u);
    contribute(&paths->planes, escapes, &paths->met, mul(paths->throughput, sky));
#  endif
  }
#endif
  if (!any_lane(hit)) return ends;
  LaneHits hits;
  load_triangles(t->triangles, &found, &hits);
  ties.flags = bits_of(hit_word(&hits, k_triangle_flags));
  if (settle_ties(t, scene, paths, &next, hit & !ties.inside, ties.flags, &found)) {
    load_triangles(t->triangles, &found, &hits);
    ties.flags = bits_of(hit_word(&hits, k_triangle_flags));
  }
  Surface s = surface_of(&hits, paths->origin, paths->direction);
  s.colors = *(const natural*)found.id + 1u;  // 0, the white row, where nothing was met
  const real3 wo = negate(paths->direction);
#ifdef DS_CAMERA_INVISIBLE
  const mask passes =
      hit & (paths->vertices == 0u) & ((ties.flags & (uint)k_flag_camera_invisible) != 0u);
  const real3 behind = offset_origin(s.position, s.error, s.normal, paths->direction);
  paths->origin = choose(passes, behind, paths->origin);
  hit = hit & !passes;
  if (!any_lane(hit)) return ends;
#endif
#ifdef DS_COVERAGE_PLANES
  cover(&paths->planes, hit & (paths->met.scatterings == 0u));
#endif
#ifdef DS_MESH_LIGHTS
#  ifdef DS_HOOK_LIGHT_PLANES
  contribute(&paths->planes, hit, &paths->met,
             mul(paths->throughput, emitted(t, &hits, &s, paths->origin, wo, hit, paths->pdf)));
#  endif
  paths->radiance =
      add(paths->radiance,
          mul(paths->throughput, emitted(t, &hits, &s, paths->origin, wo, hit, paths->pdf)));
#endif
  const mask last = hit & is_last(paths, view);
  ends.done = ends.done | last;
  const mask active = hit & !last;
  if (!any_lane(active)) return ends;
  const Sampler sampler =
      sampler_for(view->seed_low, view->seed_high, pixels->index, paths->sample);
  const natural pair = paths->vertices * (uint)k_pairs_vertex + (uint)k_pairs_camera;
  paths->vertices += choose_natural(active, (natural)(1u), (natural)(0u));
  const real2 choices = sample_pair(sampler, pair + (uint)k_pair_choices);
  real2 lobe;
  lobe.x = lobe.y = (real)(0.0f);
#if defined(DS_LOBE_CHOICE) || defined(DS_GUIDED)
  lobe = sample_pair(sampler, pair + (uint)k_pair_lobe);
#endif
  MaterialPoint m;
  natural material =
      choose_natural(hit, bits_of(hit_word(&hits, k_triangle_material)), (natural)(0u));
#ifdef DS_CHOOSERS
  material = resolve_choices(t->materials, material, active, &s, &lobe.x, &m);
#else
  read_material(t->materials, material, active, &s, &m);
#endif
  Leaving leaving;
  leaving.frame = frame_around(s.shading);
  leaving.normal = to_local(leaving.frame, s.normal);
  leaving.viewer.wo = to_local(leaving.frame, wo);
  leaving.viewer.wo.z = greater(leaving.viewer.wo.z, (real)(1e-3f));
  leaving.viewer.outside = s.outside;
  prepare_material(&m, leaving.viewer);
#ifdef DS_GUIDED
  leaving.guide = guide_at(t->guide, active & DS_GUIDED(m.type), s.position);
#endif
#ifdef DS_LIGHTS_SAMPLED
  ask_for_light(paths, active, &s, &m, &leaving, sampler, pair, choices.x, scene, t);
  shade_by_ties(paths, t, &ties, &s, *(const natural*)found.id);
#endif
  ends.closes = scatter(paths, active, &s, &m, &leaving, sampler, pair, lobe, choices.y, view);
  ask_for_layer(paths, active & !ends.closes, &ties, &s, *(const natural*)found.id);
  return ends;
}

/// Traces the queue's pixels.
DS_OUT_OF_LINE void trace_pixels(PixelQueue* queue, const __global SceneData* restrict scene_data,
                                 const __global ViewData* restrict view_data, const SceneTables* t,
                                 __global float* restrict film
#ifdef DS_HOOK_LIGHT_PLANES
                                 ,
                                 __global float* restrict light_film
#endif
                                     DS_RAY_COUNTS_ARGUMENT) {
  const SceneData scene = *scene_data;
  const ViewData view = *view_data;
  Pixels pixels;
  pixels.index = pixels.begin = pixels.end = (natural)(0u);
  pixels.x = pixels.y = (real)(0.0f);
  Sums sums;
  clear_sums(&sums, film, &view);
  Paths paths;
#ifdef DS_HOOK_LIGHT_PLANES
  clear_light_sums(&sums.light, light_film);
  paths.met.specular = paths.asked.specular = (mask)(0);
  paths.met.beyond = paths.asked.beyond = (mask)(0);
  paths.met.scatterings = paths.asked.scatterings = (natural)(0u);
  paths.met.diffuse = paths.asked.diffuse = splat((real)(0.0f));
  clear_light(&paths.planes, (mask)(-1));
  clear_light(&paths.closing_planes, (mask)(-1));
#endif
  DS_CLEAR_RAY_COUNTS(paths);
  paths.alive = paths.closes = paths.shadow.wanted = paths.rises = (mask)(0);
  paths.layer = (natural)(k_none);
  paths.shadow.origin = paths.shadow.direction = splat((real)(0.0f));
  paths.shadow.t_max = (real)(0.0f);
  paths.direct = paths.closing = splat((real)(0.0f));
  paths.sample = paths.quarter = paths.closing_quarter = (natural)(0u);
  mask busy = (mask)(0), start = (mask)(0), finished = (mask)(-1);
  for (;;) {
    if (any_lane(finished)) {
      const mask changed = change_pixels(&pixels, &sums, queue, &view, finished);
      paths.sample = choose_natural(changed, pixels.begin, paths.sample);
      start = start | changed;
      busy = (busy & !finished) | changed;
    }
    if (!any_lane(busy)) break;
    if (any_lane(start)) start_paths(&paths, start, &pixels, &view);
    const StepEnds ends = advance(&paths, &sums, &pixels, &scene, &view, t);
    const mask over = ends.done | ends.closes;
    if (any_lane(ends.done))
      add_samples(&sums, ends.done, paths.sample, paths.quarter, paths.radiance);
#ifdef DS_HOOK_LIGHT_PLANES
    if (any_lane(ends.done))
      add_light(&sums.light, ends.done, paths.quarter, sums.accepted, &paths.planes);
    copy_light(&paths.closing_planes, ends.closes, &paths.planes);
#endif
    paths.closing = choose(ends.closes, paths.radiance, paths.closing);
    paths.closing_quarter = choose_natural(ends.closes, paths.quarter, paths.closing_quarter);
    paths.closes = ends.closes;
    paths.alive = paths.alive & !over;
    paths.sample += choose_natural(over, (natural)(1u), (natural)(0u));
    start = over & (paths.sample < pixels.end);
    // A pixel whose last sample waits for its shadow ray keeps its lane for one more step.
    finished = busy & !(paths.alive | paths.closes | start);
  }
  DS_STORE_RAY_COUNTS(paths);
}

__kernel void trace_paths(
    const __global float8* restrict nodes, const __global float8* restrict leaves,
    const __global float* restrict triangles, const __global float* restrict materials,
    const __global float* restrict programs, const __global float* restrict lights,
    const __global float* restrict tables, const __global SceneData* restrict scene_data,
    const __global float* restrict guide, const __global ViewData* restrict view_data,
    const __global uint* restrict launch, __global float* restrict film
#ifdef DS_HOOK_LIGHT_PLANES
    ,
    __global float* restrict light_film
#endif
        DS_RAY_COUNTS_ARGUMENT) {
  PixelQueue queue = pixel_queue(launch, (uint)get_global_id(0));
  if (queue.next >= queue.end) return;
  SceneTables t;
  t.nodes = nodes;
  t.leaves = leaves;
  t.triangles = triangles;
  t.materials.materials = materials;
  t.materials.programs = programs;
  t.materials.tables = tables;
  t.materials.material_words = scene_data->material_words;
  t.lights.lights = lights;
  t.lights.tables = tables;
  t.lights.triangles = triangles;
  t.guide = guide;
  trace_pixels(&queue, scene_data, view_data, &t, film
#ifdef DS_HOOK_LIGHT_PLANES
               ,
               light_film
#endif
                   DS_RAY_COUNTS_PASSED);
}

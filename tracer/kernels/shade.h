// SPDX-License-Identifier: Apache-2.0
// From a surface point to its material's answers. DS_MATERIALS(X) and DS_LIGHTS(X) are the scene's
// own lists, X(name, number); what a scene does not use is not in its program
// (device/program_text.cc writes the lists).
#pragma once

#include "tracer/kernels/bsdf.h"
#include "tracer/kernels/light.h"
#include "tracer/kernels/surface.h"
#include "tracer/kernels/texture_program.h"

typedef struct {
  DS_GLOBAL float* materials;
  DS_GLOBAL float* programs;
  DS_GLOBAL float* tables;
  uint material_words;
} MaterialTables;

/// A material at a surface point: its kind, its inputs' values, and what it has derived from them,
/// lane by lane.
typedef struct {
  natural type;
  real inputs[DS_MATERIAL_INPUTS + k_most_derived];
} MaterialPoint;

/// Fills the inputs from the materials' rows, then runs the programs of textured ones, each once
/// for its lanes.
DS_FN void read_material(MaterialTables t, natural material, mask active, const Surface* s,
                         MaterialPoint* m) {
  const natural row = material * t.material_words;
  m->type = load_natural(t.materials, row + (uint)k_material_type);
  for (int i = 0; i < DS_MATERIAL_INPUTS; ++i) {
    m->inputs[i] = load(t.materials, row + (uint)(k_material_head + i));
  }
#ifdef DS_TEXTURES
  const natural program = load_natural(t.materials, row + (uint)k_material_program);
  SurfacePoint at;
  at.position = s->position;
  at.u = s->u;
  at.v = s->v;
  at.b1 = s->b1;
  at.b2 = s->b2;
  at.colors = s->colors;
  mask left = active & (program != k_none);
  while (any_lane(left)) {
    const uint code = first_of(left, program);
    const mask here = left & (program == code);
    run_texture_program(t.programs + code, t.tables, at, here, m->inputs);
    left = left & !here;
  }
#endif
}

#ifdef DS_CHOOSERS
/// Replaces every material that chooses among others by one of them. DS_CHOOSERS(X) is their list,
/// numbered from DS_FIRST_CHOOSER on. `*choice` in [0, 1) is used up and stretched back to [0, 1), so
/// that nested ones and the lobe choice after them need no further number.
DS_FN natural resolve_choices(MaterialTables t, natural material, mask active, const Surface* s,
                              real* choice, MaterialPoint* m) {
  read_material(t, material, active, s, m);
  mask left = active & (m->type >= (uint)DS_FIRST_CHOOSER);
  while (any_lane(left)) {
    natural child = (natural)(0u);
#  define DS_CHOOSE(name, number)                                                               \
    {                                                                                           \
      const mask here = left & (m->type == (uint)number);                                       \
      if (any_lane(here))                                                                       \
        child = choose_natural(here, name##_child(m->inputs, s->outside, here, choice), child); \
    }
    DS_CHOOSERS(DS_CHOOSE)
    child += material * t.material_words + (uint)k_material_child;
    material = choose_natural(left, load_natural(t.materials, child), material);
    read_material(t, material, active, s, m);
    left = active & (m->type >= (uint)DS_FIRST_CHOOSER);
  }
  return material;
}
#endif

/// Lets the materials derive what all questions of this viewer share. Lanes of other materials
/// keep their inputs, and zeros behind them.
DS_FN void prepare_material(MaterialPoint* m, Viewer viewer) {
  for (int i = 0; i < k_most_derived; ++i)
    m->inputs[DS_MATERIAL_INPUTS + i] = (real)(0.0f);
#define DS_PREPARE(name, number)                                                  \
  if (name##_derived > 0 && any_lane(m->type == (uint)number)) {                  \
    real derived[k_most_derived];                                                 \
    name##_prepare(m->inputs, viewer, derived);                                   \
    for (int i = 0; i < name##_derived; ++i)                                      \
      m->inputs[name##_end + i] =                                                 \
          choose(m->type == (uint)number, derived[i], m->inputs[name##_end + i]); \
  }
  DS_MATERIALS(DS_PREPARE)
}

/// Value and pdf of the materials at `wi` (local).
DS_INLINED BsdfValue evaluate_material(const MaterialPoint* m, Viewer viewer, real3 wi) {
  BsdfValue result = no_value();
#define DS_EVALUATE(name, number)                                 \
  {                                                               \
    const mask here = m->type == (uint)number;                    \
    if (any_lane(here)) {                                         \
      const BsdfValue v = name##_evaluate(m->inputs, viewer, wi); \
      result.value = choose(here, v.value, result.value);         \
      result.pdf = choose(here, v.pdf, result.pdf);               \
    }                                                             \
  }
  DS_MATERIALS(DS_EVALUATE)
  return result;
}

DS_FN BsdfSample choose(mask m, BsdfSample a, BsdfSample b) {
  BsdfSample s;
  s.wi = choose(m, a.wi, b.wi);
  s.weight = choose(m, a.weight, b.weight);
  s.pdf = choose(m, a.pdf, b.pdf);
  s.eta_scale = choose(m, a.eta_scale, b.eta_scale);
  s.valid = choose_mask(m, a.valid, b.valid);
  s.specular = choose_mask(m, a.specular, b.specular);
  s.glossy = choose_mask(m, a.glossy, b.glossy);
  return s;
}

DS_FN BsdfSample sample_material(const MaterialPoint* m, Viewer viewer, real2 u, real2 lobe) {
  BsdfSample result = no_sample();
#define DS_SAMPLE(name, number)                                                 \
  {                                                                             \
    const mask here = m->type == (uint)number;                                  \
    if (any_lane(here)) {                                                       \
      result = choose(here, name##_sample(m->inputs, viewer, u, lobe), result); \
    }                                                                           \
  }
  DS_MATERIALS(DS_SAMPLE)
  return result;
}

#ifdef DS_LIGHTS_SAMPLED
/// The candidate of a round and a way to it: light number `round` in all lanes where there are as
/// many rounds as lights, else one chosen by selection probability, `choice` in [0, 1). The pdf
/// includes the choice.
DS_FN LightSample sample_light(LightTables t, const SceneData* scene, uint round, mask active,
                               real3 from, real choice, real2 u) {
  LightSample result = no_light();
  const bool each = scene->light_rounds > 1u;
  const uint end = each ? round + 1u : scene->light_count;
  real low = (real)(0.0f);
  for (uint i = round; i < end; ++i) {
    const float probability = t.lights[i * k_light_words + k_light_probability];
    const real high = (real)(each ? 1.0f : t.tables[scene->light_table + i]);
    const mask here = active & (choice >= low) & (choice < high);
    low = high;
    if (probability == 0.0f || !any_lane(here)) continue;
    const uint at = i * k_light_words + k_light_parameters;
    const uint kind = as_uint(t.lights[i * k_light_words + k_light_kind]);
#  define DS_SAMPLE_LIGHT(name, number)              \
    if (kind == number) {                            \
      LightSample s = name##_sample(t, at, from, u); \
      s.pdf = s.pdf * probability;                   \
      result = choose(here, s, result);              \
    }
    DS_LIGHTS(DS_SAMPLE_LIGHT)
  }
  return result;
}
#endif

/// Weight of strategy a against b (Veach 1997, eq. 9.23, power 2), as a quotient so that no pdf
/// overflows.
DS_FN real power_heuristic(real a, real b) {
  const real ratio = b / greater(a, (real)(1e-30f));
  return 1.0f / (1.0f + ratio * ratio);
}

#ifdef DS_ESCAPE_LIGHTS
/// Radiance of the lights beyond the scene, weighed against having sampled them. `pdf`: of the BSDF
/// sample that went this way; negative where no other strategy could (camera rays, specular
/// bounces).
DS_FN real3 escape_radiance(LightTables t, uint first, uint light_count, real3 direction,
                            real pdf) {
  real3 sum = splat((real)(0.0f));
  for (uint i = first; i < light_count; ++i) {
    const float probability = t.lights[i * k_light_words + k_light_probability];
    const uint at = i * k_light_words + k_light_parameters;
    const uint kind = as_uint(t.lights[i * k_light_words + k_light_kind]);
    real light_pdf = (real)(0.0f);
    real3 radiance = splat((real)(0.0f));
#  define DS_ESCAPE(name, number) \
    if (kind == number) radiance = name##_escape(t, at, direction, &light_pdf);
    DS_ESCAPE_LIGHTS(DS_ESCAPE)
    const real weight =
        choose(pdf < 0.0f, (real)(1.0f), power_heuristic(pdf, light_pdf * probability));
    sum = add_scaled(sum, radiance, weight);
  }
  return sum;
}
#endif

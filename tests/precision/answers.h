// SPDX-License-Identifier: Apache-2.0
// The answers of questions.h by the kernels of namespace ds::DS_KERNELS, in namespace
// ds::audit::DS_AUDIT. Included once by each of the two builds.
#pragma once

#include "tests/precision/kernels_for_audit.h"
#include "tests/precision/questions.h"
#include "tests/tracer/kernels/mix_on_host.h"
#include "tracer/kernels/lists.h"
#include "tracer/kernels/prepared.h"

#include <bit>
#include <cstring>

namespace ds::audit::DS_AUDIT {

using namespace ds::DS_KERNELS;

namespace {

real3 of(const std::array<float, 3>& v) {
  return vec(real{v[0]}, real{v[1]}, real{v[2]});
}
real2 of(float x, float y) {
  real2 r;
  r.x = real{x};
  r.y = real{y};
  return r;
}
Three three(real3 v) {
  return {double{v.x}, double{v.y}, double{v.z}};
}

}  // namespace

BsdfAnswer ask(const BsdfQuestion& q) {
  const std::vector<real> inputs(q.inputs.begin(), q.inputs.end());
  const real* p = inputs.data();
  Viewer viewer;
  viewer.wo = of(q.wo);
  viewer.outside = q.outside;
  BsdfValue value = no_value();
  BsdfSample sample = no_sample();
  int row = 0;
#define DS_ASK(sdl_name, prefix, PREFIX)                                                      \
  if (row++ == q.material) {                                                                  \
    value = prefix##_evaluate(DS_PREPARED(prefix, p, viewer), viewer, of(q.wi));              \
    sample = prefix##_sample(DS_PREPARED(prefix, p, viewer), viewer,                          \
                             of(q.numbers[0], q.numbers[1]), of(q.numbers[2], q.numbers[3])); \
  }
  DS_ALL_MATERIALS(DS_ASK)
#undef DS_ASK
  BsdfAnswer a;
  a.value = three(value.value);
  a.pdf = double{value.pdf};
  a.valid = sample.valid;
  a.specular = sample.specular;
  a.glossy = sample.glossy;
  a.sampled = three(sample.wi);
  a.weight = three(sample.weight);
  a.sampled_pdf = double{sample.pdf};
  return a;
}

LightAnswer ask(const LightQuestion& q) {
  const LightTables t = {q.lights->data(), q.tables->data(), q.triangles->data()};
  const uint at = k_light_parameters;
  const real3 from = of(q.from);
  const real2 u = of(q.numbers[0], q.numbers[1]);
  LightSample s = no_light();
  real3 escape = splat(real{0});
  real escape_pdf = 0;
  int row = 0;  // in the order of DS_ALL_LIGHTS
#define DS_ASK(sdl_name, prefix) \
  if (row++ == q.light) s = prefix##_sample(t, at, from, u);
#define DS_ASK_BEYOND(sdl_name, prefix)                            \
  if (row++ == q.light) {                                          \
    s = prefix##_sample(t, at, from, u);                           \
    escape = prefix##_escape(t, at, of(q.direction), &escape_pdf); \
  }
  DS_ASK("", mesh)
  DS_UNMET_LIGHTS(DS_ASK)
  DS_BEYOND_LIGHTS(DS_ASK_BEYOND)
#undef DS_ASK
#undef DS_ASK_BEYOND
  return {three(s.wi), three(s.radiance), double{s.pdf}, three(escape), double{escape_pdf}};
}

namespace {
ViewData view_of(const std::array<float, 44>& words) {
  ViewData view;
  static_assert(sizeof(view) == sizeof(words));
  std::memcpy(&view, words.data(), sizeof(view));
  return view;
}
}  // namespace

Three ask(const SkyQuestion& q) {
  const ViewData view = view_of(q.view);
  const Sampler sampler =
      sampler_for(view.seed_low, view.seed_high, q.y * view.width + q.x, q.sample);
  const real2 f = sample_pair(sampler, 0u);
  const real x = to_real(q.x) + 0.5f + (f.x - 0.5f);
  const real y = to_real(q.y) + 0.5f + (f.y - 0.5f);
  const CameraRay ray = camera_ray(&view, x, y, of(0, 0));
  const LightTables t = {q.lights->data(), q.tables->data(), nullptr};
  real pdf = 0;
  return three(infinite_escape(t, k_light_parameters, ray.direction, &pdf));
}

CameraAnswer ask(const CameraQuestion& q) {
  const ViewData view = view_of(q.view);
  const CameraRay ray = camera_ray(&view, real{q.place[0]}, real{q.place[1]},
                                   of(q.lens_numbers[0], q.lens_numbers[1]));
  return {three(ray.origin), three(ray.direction)};
}

namespace {
struct Triangle {
  real3 p0, e1, e2;
};
Triangle triangle_of(const std::array<std::array<float, 3>, 3>& corners) {
  const real3 p0 = of(corners[0]);
  return {p0, sub(of(corners[1]), p0), sub(of(corners[2]), p0)};
}
/// As surface_of of path.cl.
real3 position_on(const Triangle& t, real b1, real b2) {
  return add(t.p0, add_scaled(scale(t.e1, b1), t.e2, b2));
}
double error_on(const Triangle& t) {
  return double{position_error(t.p0, t.e1, t.e2)};
}
}  // namespace

HitAnswer ask(const HitQuestion& q) {
  const real2 weights = hit_weights(of(q.origin), of(q.direction), of(q.corners[0]),
                                    of(q.corners[1]), of(q.corners[2]));
  const Triangle t = triangle_of(q.corners);
  return {double{weights.x}, double{weights.y}, three(position_on(t, weights.x, weights.y)),
          error_on(t)};
}

SurfaceAnswer ask(const SurfaceQuestion& q) {
  const Triangle t = triangle_of(q.corners);
  return {three(position_on(t, real{q.b1}, real{q.b2})), three(triangle_normal(t.e1, t.e2)),
          error_on(t)};
}

}  // namespace ds::audit::DS_AUDIT

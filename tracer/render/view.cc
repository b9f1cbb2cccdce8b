// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/view.h"

#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/render/engine_text.h"
#include "tracer/render/film.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ds {
namespace {

void store(float (&out)[3], Vec3d v) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.y);
  out[2] = static_cast<float>(v.z);
}

}  // namespace

CameraFrame camera_frame(const Camera& camera) {
  for (const Vec3d& v : {camera.position, camera.target, camera.up})
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      fail(ErrorKind::recipe, "a camera's position, target and up must be finite, got {} {} {}",
           v.x, v.y, v.z);
  CameraFrame f;
  for (const Vec3d& v : {camera.position, camera.target})
    if (std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}) > k_farthest_coordinate)
      fail(ErrorKind::recipe, "a camera's position and target must be within {:g}, got {} {} {}",
           k_farthest_coordinate, v.x, v.y, v.z);
  f.forward = normalized(camera.target - camera.position);
  if (f.forward == Vec3d{}) fail(ErrorKind::recipe, "a camera's target must not be its position");
  for (const Vec3d& up : {camera.up, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    const Vec3d right = cross(f.forward, normalized(up));
    if (length(right) < 1e-6) continue;
    f.right = normalized(right);
    f.up = cross(f.right, f.forward);
    break;
  }
  return f;
}

namespace {

/// Readers hold recipes to this; a camera of a program's own comes here unchecked.
void check_lens(const Camera& camera) {
  const CameraType& type = type_of(camera);
  if (!type.host.range.contains(span_of(camera)))
    fail(ErrorKind::recipe, "a camera's {} must be {}, got {}", type.span_name(),
         type.host.range.text(), span_of(camera));
  if (!(camera.lens_radius_m >= 0 && std::isfinite(camera.lens_radius_m)))
    fail(ErrorKind::recipe, "a camera's lens_radius_m must be finite and not negative, got {}",
         camera.lens_radius_m);
  if (camera.lens_radius_m > 0 &&
      !(camera.focus_distance_m > 0 && std::isfinite(camera.focus_distance_m)))
    fail(ErrorKind::recipe, "a camera's focus_distance_m must be finite and above 0, got {}",
         camera.focus_distance_m);
}

}  // namespace

kernels::ViewData view_data(const Camera& camera, const EngineSettings& engine, double start_m) {
  const CameraFrame f = camera_frame(camera);
  check_lens(camera);
  const ShownSides sides = shown_by(camera, engine.width, engine.height);
  const Vec3d right = f.right * sides.x_per_metre;
  const Vec3d up = f.up * sides.y_per_metre;
  kernels::ViewData v{};
  store(v.start, camera.position + f.forward * start_m);
  store(v.start_right, right * start_m);
  store(v.start_up, up * start_m);
  if (sides.x_m > 0) {
    store(v.start_right, right * start_m + f.right * sides.x_m);
    store(v.start_up, up * start_m + f.up * sides.y_m);
  }
  v.start_depth = static_cast<float>(start_m);
  store(v.right, right);
  store(v.up, up);
  store(v.forward, f.forward);
  store(v.lens_right, f.right * camera.lens_radius_m);
  store(v.lens_up, f.up * camera.lens_radius_m);
  // Rays through one pixel meet in the plane in focus.
  const double to_focus =
      camera.lens_radius_m > 0 ? camera.lens_radius_m * (1 - start_m / camera.focus_distance_m) : 0;
  store(v.start_lens_right, f.right * to_focus);
  store(v.start_lens_up, f.up * to_focus);
  v.focus_distance = static_cast<float>(camera.focus_distance_m);
  v.width = static_cast<std::uint32_t>(engine.width);
  v.height = static_cast<std::uint32_t>(engine.height);
  static_assert(kernels::k_tile_side == k_tile_size);
  v.tiles_x = (v.width + kernels::k_tile_side - 1) / kernels::k_tile_side;
  v.sample_limit =
      engine.outlier_limit > 0 ? std::min(engine.outlier_limit, k_sample_most) : k_sample_most;
  v.seed_low = static_cast<std::uint32_t>(engine.seed);
  v.seed_high = static_cast<std::uint32_t>(engine.seed >> 32);
  v.depth_total = static_cast<std::uint32_t>(engine.depth_total);
  v.depth_diffuse = static_cast<std::uint32_t>(engine.depth_diffuse);
  v.depth_glossy = static_cast<std::uint32_t>(engine.depth_glossy);
  v.depth_specular = static_cast<std::uint32_t>(engine.depth_specular);
  v.roulette_depth = static_cast<std::uint32_t>(engine.roulette_depth);
  v.roulette_cap = engine.roulette_cap;
  return v;
}

std::string canonical_camera(const Camera& camera) {
  CanonicalText text;
  const auto add = [&](const char* name, Vec3d v) {
    text.add(name, std::span<const double>(std::array{v.x, v.y, v.z}));
  };
  if (camera.type != 0) text.add("type", type_of(camera).name);
  add("position", camera.position);
  add("target", camera.target);
  add("up", camera.up);
  text.add(type_of(camera).span_name(), span_of(camera));
  text.add("lens_radius_m", camera.lens_radius_m);
  // A pinhole has no focus.
  if (camera.lens_radius_m > 0) text.add("focus_distance_m", camera.focus_distance_m);
  return text.text();
}

std::string canonical_engine(const EngineSettings& engine, std::string_view program) {
  CanonicalText text;
  if (engine.target) {
    text.add("error", engine.target->error);
    text.add("max_spp", engine.target->max_spp);
  } else {
    text.add("spp", engine.spp);
  }
  return text.text() + canonical_kept_engine(engine, program);
}

std::string canonical_kept_engine(const EngineSettings& engine, std::string_view program) {
  CanonicalText text;
  text.add("width", engine.width);
  text.add("height", engine.height);
  if (engine.target) {
    // What the picture is developed with decides where its samples go.
    text.add("schedule_version", k_schedule_version);
    for (const auto& [name, value] : parse_canonical(canonical_tone_map(engine.target->tone_map)))
      text.add("schedule." + name, value);
    if (engine.target->region == ErrorRegion::model) text.add("schedule.region", "model");
  }
  text.add("depth_total", engine.depth_total);
  text.add("depth_diffuse", engine.depth_diffuse);
  text.add("depth_glossy", engine.depth_glossy);
  text.add("depth_specular", engine.depth_specular);
  text.add("roulette_depth", engine.roulette_depth);
  text.add("roulette_cap", engine.roulette_cap);
  text.add("filter_width", engine.filter_width);
  text.add("seed", engine.seed);
  if (engine.outlier_limit > 0) text.add("outlier_limit", engine.outlier_limit);
  text.add("math", engine.math == MathMode::strict ? "strict" : "fast");
  text.add("host_render_version", k_host_render_version);
  text.add("program", program);
  return text.text();
}

std::string canonical_engine(const Scene& scene, const Camera& camera,
                             const EngineSettings& engine) {
  return canonical_engine(engine, program_tokens(path_program_text(scene_effects(scene, camera))));
}

std::string canonical_kept_engine(const Scene& scene, const Camera& camera,
                                  const EngineSettings& engine) {
  return canonical_kept_engine(engine,
                               program_tokens(path_program_text(scene_effects(scene, camera))));
}

}  // namespace ds

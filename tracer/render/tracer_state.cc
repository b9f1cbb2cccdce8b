// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/tracer_state.h"

#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <utility>

namespace ds {

Tracer::State::State(const TracerOptions& o)
    : options(o),
      device(o.device),
      lanes(o.lanes != 0 ? o.lanes : default_lanes(device.info())),
      programs(device,
               fmt::format("-DDS_LANES={}{}{}", lanes, o.count_rays ? " -DDS_COUNT_RAYS" : "",
                           o.plain_sums ? " -DDS_PLAIN_SUMS" : ""),
               o.cache_folder),
      maker(o.high_quality_bvh ? BvhQuality::high : BvhQuality::medium, o.bvh_width,
            o.full_program),
      guides(device, o.cache_folder) {
  if (options.bvh_width < k_least_bvh_width || options.bvh_width > k_most_bvh_width)
    fail(ErrorKind::usage, "bvh_width must be in [{}, {}], got {}", k_least_bvh_width,
         k_most_bvh_width, options.bvh_width);
  // A CPU's threads take groups as they get done: small ones share a launch out evenly. A GPU
  // runs a group's items side by side.
  local_size = options.work_group_size != 0 ? static_cast<std::size_t>(options.work_group_size)
               : device.info().is_cpu       ? 1
                                            : 64;
}

void Tracer::State::prepare(const Camera& camera, const EngineSettings& engine,
                            const std::vector<const PlaneType*>& light_planes) {
  if (!ready) fail(ErrorKind::device, "no scene was set before tracing");
  maker.load_images(*ready);
  SceneEffects numbering = effects(scene(), camera);
  const SceneEffects wanted = with_light_planes(numbering, light_planes);
  // The lens changes the program, not the numbers in the tables.
  numbering.lens = false;
  const std::size_t photons = wanted.guide ? photons_for(engine) : 0;
  const bool lacks_photons = guide_photons != photons && photons > 0 && !packed;
  if (!packed_for || *packed_for != numbering || lacks_photons)
    take(words_for(numbering), numbering);
  if (guide_photons != photons) {
    guide = device.upload(guide_words(photons));
    guide_photons = photons;
    packed.reset();
  }
  if (!program_for || *program_for != wanted || program_math != engine.math) {
    path_kernel = device.kernel(programs.get(wanted, engine.math), "trace_paths");
    program_for = wanted;
    program_math = engine.math;
  }
}

void Tracer::State::forget_scene() {
  ready.reset();
  on_device = false;
  packed_for.reset();
  packed.reset();
  device_model.reset();
}

PackedScene Tracer::State::words_for(const SceneEffects& numbering) {
  if (ready->packed && ready->numbering == numbering)
    return *std::exchange(ready->packed, std::nullopt);
  return maker.pack(scene(), numbering);
}

void Tracer::State::take(PackedScene scene_words, const std::optional<SceneEffects>& numbering) {
  on_device = false;
  device_scene.take(device, scene_words, uploads);
  on_device = true;
  packed_for = numbering;
  guide_photons.reset();
  if (numbering && numbering->guide) packed = std::move(scene_words);
}

void Tracer::State::take_surfaces() {
  if (on_device) return;
  if (ready->packed)
    take(*std::exchange(ready->packed, std::nullopt), ready->numbering);
  else
    take(maker.pack_surfaces(scene()), std::nullopt);
}

void Tracer::State::take_materials(const Camera& camera) {
  if (packed_for) return;
  maker.load_images(*ready);
  SceneEffects numbering = effects(scene(), camera);
  numbering.lens = false;
  take(words_for(numbering), numbering);
}

std::vector<std::uint32_t> Tracer::State::guide_words(std::size_t photons) {
  if (photons == 0) return std::vector<std::uint32_t>(1);
  if (std::exchange(ready->guide_photons, 0) == photons) return std::exchange(ready->guide, {});
  return guides.make(scene(), *packed, *packed_for, photons);
}

bool Tracer::State::is_lit(const Camera& camera) const {
  return !scene_effects(scene(), camera).lights.empty();
}

void Tracer::State::start_counting(unsigned argument, std::size_t items) {
  if (!options.count_rays) return;
  count_rows = device.make_buffer(items * kernels::k_ray_counts * sizeof(std::uint32_t));
  device.fill_zero(count_rows);
  path_kernel.set(argument, count_rows);
}

void Tracer::State::add_counts() {
  if (!options.count_rays) return;
  std::vector<std::uint32_t> words(count_rows.size_bytes() / sizeof(std::uint32_t));
  device.read(count_rows, std::as_writable_bytes(std::span(words)));
  for (std::size_t i = 0; i < words.size(); i += kernels::k_ray_counts) {
    ray_counts.camera += words[i + kernels::k_count_camera];
    ray_counts.extension += words[i + kernels::k_count_extension];
    ray_counts.shadow += words[i + kernels::k_count_shadow];
  }
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/tracer_state.h"

#include "tracer/base/error.h"
#include "tracer/render/guide.h"
#include "tracer/scene/sdl.h"

#include <algorithm>

namespace ds {
namespace {

/// Two for each pixel, so that a small picture is not longer under way for them than for its own
/// samples. Not by spp: more samples go on from a kept film.
std::size_t photons_for(const EngineSettings& engine) {
  const std::size_t pixels =
      static_cast<std::size_t>(engine.width) * static_cast<std::size_t>(engine.height);
  return std::clamp(2 * pixels, std::size_t{1} << 14, std::size_t{1} << 17);
}

}  // namespace

Tracer::State::State(const TracerOptions& o)
    : options(o),
      device(o.device),
      lanes(o.lanes != 0 ? o.lanes : default_lanes(device.info())),
      programs(device,
               fmt::format("-DDS_LANES={}{}{}", lanes, o.count_rays ? " -DDS_COUNT_RAYS" : "",
                           o.plain_sums ? " -DDS_PLAIN_SUMS" : ""),
               o.cache_folder) {
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
  if (!scene) fail(ErrorKind::device, "no scene was set before tracing");
  Features numbering = features(*scene, camera);
  const Features wanted = with_light_planes(numbering, light_planes);
  // The lens changes the program, not the numbers in the tables.
  numbering.lens = false;
  const std::size_t photons = wanted.guide ? photons_for(engine) : 0;
  const bool lacks_photons = guide_photons != photons && photons > 0 && !packed;
  if (!packed_for || *packed_for != numbering || lacks_photons)
    take(pack_scene(*scene, wanted, quality(), options.bvh_width, &pack_cache), numbering);
  if (guide_photons != photons) {
    guide = device.upload(photons > 0 ? make_guide(photons) : std::vector<std::uint32_t>(1));
    guide_photons = photons;
    packed.reset();
  }
  if (!program_for || *program_for != wanted || program_math != engine.math) {
    path_kernel = device.kernel(programs.get(wanted, engine.math), "trace_paths");
    program_for = wanted;
    program_math = engine.math;
  }
}

void Tracer::State::take(PackedScene scene_words, const Features& numbering) {
  device_scene.take(device, scene_words, uploads);
  packed_for = numbering;
  guide_photons.reset();
  if (numbering.guide) packed = std::move(scene_words);
}

std::vector<std::uint32_t> Tracer::State::make_guide(std::size_t photon_count) {
  if (!has_rays_program) {
    rays_kernel = device.kernel(
        device.build(rays_program_text(), k_strict_options, options.cache_folder), "trace_nearest");
    has_rays_program = true;
  }
  const TraceRays trace_rays = [&](std::span<const RayWords> rays) {
    const std::size_t count = round_up(std::max<std::size_t>(rays.size(), 1), 64);
    std::vector<RayWords> padded(rays.begin(), rays.end());
    padded.resize(count, RayWords{{0, 0, 0}, {0, 0, 1}, 0});
    const Buffer in = device.upload(padded);
    const Buffer out = device.make_buffer(count * sizeof(RayAnswer));
    rays_kernel.set(0, device_scene.nodes);
    rays_kernel.set(1, device_scene.leaves);
    rays_kernel.set(2, in);
    rays_kernel.set(3, out);
    device.run(rays_kernel, 0, count, 64);
    std::vector<RayAnswer> answers(rays.size());
    device.read(out, std::as_writable_bytes(std::span(answers)));
    return answers;
  };
  const std::vector<Photon> photons =
      trace_photons(*scene, *packed, *packed_for, photon_count, trace_rays);
  Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (const Object& object : scene->objects) {
    if (object.id != k_model_object_id) continue;
    for (const Vec3& p : object.mesh.positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  const Vec3 half = 0.5f * (high - low);
  return guide_table(photons, low + half, std::sqrt(dot(half, half)));
}

bool Tracer::State::is_lit(const Camera& camera) const {
  return !features_of(*scene, camera).lights.empty();
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

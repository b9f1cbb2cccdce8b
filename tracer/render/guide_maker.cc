// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/guide_maker.h"

#include "tracer/render/guide.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ds {
namespace {

constexpr std::size_t k_group = 64;

struct Ball {
  Vec3 centre;
  float radius;
};

/// Around the model's bounds.
Ball ball_of_model(const Scene& scene) {
  Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (const Object& object : scene.objects) {
    if (object.id != k_model_object_id) continue;
    for (const Vec3& p : object.mesh.positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  const Vec3 half = 0.5f * (high - low);
  return {low + half, std::sqrt(dot(half, half))};
}

}  // namespace

/// Two for each pixel, so that a small picture is not longer under way for them than for its own
/// samples. Not by spp: more samples go on from a kept film.
std::size_t photons_for(const EngineSettings& engine) {
  const std::size_t pixels =
      static_cast<std::size_t>(engine.width) * static_cast<std::size_t>(engine.height);
  return std::clamp(2 * pixels, std::size_t{1} << 12, std::size_t{1} << 17);
}

GuideMaker::GuideMaker(const Device& device, std::filesystem::path cache_folder)
    : device_(device.beside()), cache_folder_(std::move(cache_folder)) {}

std::vector<RayAnswer> GuideMaker::trace(std::span<const RayWords> rays, const Buffer& nodes,
                                         const Buffer& leaves) {
  const std::size_t count =
      (std::max<std::size_t>(rays.size(), 1) + k_group - 1) / k_group * k_group;
  std::vector<RayWords> padded(rays.begin(), rays.end());
  padded.resize(count, RayWords{{0, 0, 0}, {0, 0, 1}, 0});
  const Buffer in = device_.upload(padded);
  const Buffer out = device_.make_buffer(count * sizeof(RayAnswer));
  rays_kernel_.set(0, nodes);
  rays_kernel_.set(1, leaves);
  rays_kernel_.set(2, in);
  rays_kernel_.set(3, out);
  device_.run(rays_kernel_, 0, count, k_group);
  std::vector<RayAnswer> answers(rays.size());
  device_.read(out, std::as_writable_bytes(std::span(answers)));
  return answers;
}

std::vector<std::uint32_t> GuideMaker::make(const Scene& scene, const PackedScene& packed,
                                            const SceneEffects& numbering, std::size_t photons) {
  const std::lock_guard lock(mutex_);
  if (!has_program_) {
    rays_kernel_ = device_.kernel(
        device_.build(rays_program_text(), k_strict_options, cache_folder_), "trace_nearest");
    has_program_ = true;
  }
  const Buffer nodes = device_.upload(packed.bvh.nodes), leaves = device_.upload(packed.bvh.leaves);
  const std::vector<Photon> found =
      trace_photons(scene, packed, numbering, photons,
                    [&](std::span<const RayWords> rays) { return trace(rays, nodes, leaves); });
  const Ball ball = ball_of_model(scene);
  return guide_table(found, photons, ball.centre, ball.radius);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/scene_maker.h"

#include "tracer/scene/scene_check.h"

#include <utility>

namespace ds {
namespace {

/// Of images, and of what is made of scenes, that are kept for scenes to come.
constexpr std::size_t k_most_cached_bytes = std::size_t{256} << 20U;

}  // namespace

SceneMaker::SceneMaker(BvhQuality quality, int bvh_width, bool full_program)
    : quality_(quality),
      bvh_width_(bvh_width),
      full_program_(full_program),
      images_(k_most_cached_bytes),
      cache_(k_most_cached_bytes) {}

void SceneMaker::load_images(ReadyScene& ready) {
  if (ready.has_images) return;
  const std::lock_guard lock(mutex_);
  images_.load(ready.scene);
  ready.has_images = true;
}

ReadyScene SceneMaker::take(Scene scene, SceneUse use) {
  ReadyScene ready;
  ready.scene = std::move(scene);
  check_scene(ready.scene);
  if (use == SceneUse::pictures)
    load_images(ready);  // pixels of files are checked as they are read
  return ready;
}

void SceneMaker::pack_ahead(ReadyScene& ready) {
  if (ready.has_images) {
    ready.numbering = numbering(ready.scene);
    ready.packed = pack(ready.scene, *ready.numbering);
  } else {
    ready.packed = pack_surfaces(ready.scene);
  }
}

SceneEffects SceneMaker::numbering(const Scene& scene) const {
  SceneEffects effects = scene_effects(scene, Camera{});
  if (full_program_) effects = full_effects(effects);
  effects.lens = false;
  return effects;
}

PackedScene SceneMaker::pack(const Scene& scene, const SceneEffects& numbering) {
  const std::lock_guard lock(mutex_);
  return pack_scene(scene, numbering, quality_, bvh_width_, &cache_);
}

PackedScene SceneMaker::pack_surfaces(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  return ds::pack_surfaces(scene, quality_, bvh_width_, &cache_);
}

}  // namespace ds

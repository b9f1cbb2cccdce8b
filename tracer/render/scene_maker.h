// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/program_text.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/loaded_images.h"
#include "tracer/render/render.h"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace ds {

/// A scene for which all was done that can be while another one is on the device.
struct ReadyScene {
  Scene scene;
  bool has_images = false;  ///< they are loaded
  /// Packed with these effects' numbers; none: for planes, which ask for no material.
  std::optional<SceneEffects> numbering;
  std::optional<PackedScene> packed;
  std::size_t guide_photons = 0;     ///< that `guide` is made of; 0: there is none
  std::vector<std::uint32_t> guide;  ///< GuideMaker's
};

/// Makes scenes ready, on the host alone, and keeps what scenes to come have in common with them:
/// loaded pictures, sampling tables, trees. Any thread may ask, also while others trace; one waits
/// for another.
class SceneMaker {
 public:
  SceneMaker(BvhQuality quality, int bvh_width, bool full_program);

  /// Loads images where pictures are wanted, and checks the scene's numbers. Throws Error(asset).
  ReadyScene take(Scene scene, SceneUse use);
  /// Packs it for that use.
  void pack_ahead(ReadyScene& ready);
  /// Loads the scene's images where that was not done.
  void load_images(ReadyScene& ready);
  /// Of the scene in whatever light and by whatever camera it is seen: no lens.
  SceneEffects numbering(const Scene& scene) const;
  PackedScene pack(const Scene& scene, const SceneEffects& numbering);
  /// What planes read.
  PackedScene pack_surfaces(const Scene& scene);

 private:
  BvhQuality quality_;
  int bvh_width_;
  bool full_program_;
  std::mutex mutex_;  ///< for all below
  LoadedImages images_;
  PackCache cache_;
};

}  // namespace ds

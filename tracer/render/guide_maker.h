// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/photons.h"
#include "tracer/render/render.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <vector>

namespace ds {

/// How many photons are sent for a picture's guide to caustics.
std::size_t photons_for(const EngineSettings& engine);

/// Makes guides to caustics: traces a scene's photons, with rays on the device by a queue of its own,
/// and makes their table. Any thread may ask, also while others trace; one waits for another.
class GuideMaker {
 public:
  /// Works beside this device, which must outlive it. `cache_folder`: as Device::build.
  GuideMaker(const Device& device, std::filesystem::path cache_folder);

  /// The words that kernels/guide.h reads.
  std::vector<std::uint32_t> make(const Scene& scene, const PackedScene& packed,
                                  const SceneEffects& numbering, std::size_t photons);

 private:
  std::vector<RayAnswer> trace(std::span<const RayWords> rays, const Buffer& nodes,
                               const Buffer& leaves);

  std::mutex mutex_;  ///< for all below
  Device device_;
  std::filesystem::path cache_folder_;
  Kernel rays_kernel_;
  bool has_program_ = false;
};

}  // namespace ds

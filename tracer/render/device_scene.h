// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"
#include "tracer/device/opencl.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/render.h"

#include <array>

namespace ds {

/// A scene's tables in device memory.
struct DeviceScene {
  Buffer nodes, leaves, triangles, materials, texture_code, lights, tables, data;
  std::array<Hash128, 8> words{};  ///< hashes of what they hold, in this order

  /// Uploads the tables that hold other words than these.
  void take(const Device& device, const PackedScene& packed, UploadCounts& counts);
};

}  // namespace ds

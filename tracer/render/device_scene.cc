// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/device_scene.h"

#include <cstddef>
#include <span>
#include <utility>

namespace ds {

void DeviceScene::take(const Device& device, const PackedScene& packed, UploadCounts& counts) {
  const auto bytes = [](const auto& values) { return std::as_bytes(std::span(values)); };
  const std::array<std::pair<Buffer*, std::span<const std::byte>>, 8> all = {
      {{&nodes, bytes(packed.bvh.nodes)},
       {&leaves, bytes(packed.bvh.leaves)},
       {&triangles, bytes(packed.triangles.words())},
       {&materials, bytes(packed.materials.words())},
       {&texture_code, bytes(packed.texture_code.words())},
       {&lights, bytes(packed.lights.words())},
       {&tables, bytes(packed.tables.words())},
       {&data, std::as_bytes(std::span(&packed.data, 1))}}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [buffer, values] = all[i];
    const Hash128 hash = hash_bytes(values);
    const bool known = words[i] == hash && buffer->size_bytes() == values.size();
    ++(known ? counts.kept_tables : counts.tables);
    (known ? counts.kept_bytes : counts.bytes) += values.size();
    if (known) continue;
    words[i] = {};  // an upload that fails leaves nothing known
    *buffer = device.upload(values);
    words[i] = hash;
  }
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/device/program_text.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene.h"

#include <bit>
#include <cstdint>
#include <vector>

namespace ds {

/// Words of a device table: floats, or the bits of unsigned numbers.
class Words {
 public:
  void add(float value) { words_.push_back(std::bit_cast<std::uint32_t>(value)); }
  void add(std::uint32_t value) { words_.push_back(value); }
  void add(Vec3 v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  /// Offset of what is added next.
  std::uint32_t offset() const { return static_cast<std::uint32_t>(words_.size()); }
  void pad_to(std::size_t size) { words_.resize(size, 0); }
  const std::vector<std::uint32_t>& words() const { return words_; }

 private:
  std::vector<std::uint32_t> words_;
};

/// A scene as the kernels read it (kernels/scene_data.h).
struct PackedScene {
  Bvh bvh;
  Words triangles, materials, programs, lights, tables;
  kernels::SceneData data{};
};

/// Images must be loaded. `features` gives the numbers of materials, textures and lights: the
/// scene's own, or all_features(). Throws Error(asset) for a scene without triangles or with what
/// the tracer cannot hold. `bvh_width`: build_bvh's.
PackedScene pack_scene(const Scene& scene, const Features& features, BvhQuality quality,
                       int bvh_width = k_most_bvh_width);

/// A triangle's row number where objects stand one behind the other: index of the object's first
/// triangle.
std::vector<std::uint32_t> first_triangles(const Scene& scene);

/// Appends the lights' rows and tables and fills the light fields of `packed.data`.
/// `mesh_lights[o]` becomes the row of the light that object o is, or k_none.
void pack_lights(const Scene& scene, const Features& features, PackedScene& packed,
                 std::vector<std::uint32_t>& mesh_lights);

}  // namespace ds

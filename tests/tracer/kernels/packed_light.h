// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/pictures.h"
#include "tracer/device/scene_pack.h"
#include "tracer/kernels/all_nodes.h"

#include <bit>
#include <utility>
#include <vector>

namespace ds {

/// The tables of a scene of one light as the kernels' functions take them.
class PackedLight {
 public:
  explicit PackedLight(const Scene& scene) {
    SceneEffects effects = scene_effects(scene, Camera{});
    packed_ = pack_scene(scene, effects, BvhQuality::low);
    for (const auto& [from, to] : {std::pair{&packed_.lights, &lights_},
                                   {&packed_.tables, &tables_},
                                   {&packed_.triangles, &triangles_}})
      for (const std::uint32_t word : from->words())
        to->push_back(std::bit_cast<float>(word));
  }
  kernels::LightTables tables() const {
    return {lights_.data(), tables_.data(), triangles_.data()};
  }
  static constexpr kernels::uint at = kernels::k_light_parameters;

 private:
  PackedScene packed_;
  std::vector<float> lights_, tables_, triangles_;
};

/// A scene of one small matte triangle that reaches as far as a unit cube's half.
inline Scene lit_scene() {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}),
                       pictures::add_matte(scene, {1, 1, 1}));
  return scene;
}

}  // namespace ds

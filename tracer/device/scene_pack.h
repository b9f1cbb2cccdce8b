// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/accel/bvh.h"
#include "tracer/accel/tree_cache.h"
#include "tracer/base/kept.h"
#include "tracer/device/program_text.h"
#include "tracer/device/ties.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace ds {

/// Words of a device table: floats, or the bits of unsigned numbers.
class Words {
 public:
  void add(float value) { words_.push_back(std::bit_cast<std::uint32_t>(value)); }
  void add(std::uint32_t value) { words_.push_back(value); }
  void add(std::span<const std::uint32_t> words) {
    words_.insert(words_.end(), words.begin(), words.end());
  }
  void add(std::span<const float> values) {
    const std::size_t before = words_.size();
    words_.resize(before + values.size());
    if (!values.empty()) std::memcpy(words_.data() + before, values.data(), values.size_bytes());
  }
  void add(const Words& words) { add(std::span(words.words_)); }
  void add(Vec3 v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  /// Offset of what is added next.
  std::uint32_t offset() const { return static_cast<std::uint32_t>(words_.size()); }
  void pad_to(std::size_t size) { words_.resize(size, 0); }
  void reserve(std::size_t size) { words_.reserve(size); }
  std::uint32_t& at(std::size_t place) { return words_.at(place); }
  const std::vector<std::uint32_t>& words() const { return words_; }

 private:
  std::vector<std::uint32_t> words_;
};

/// A scene as the kernels read it (kernels/scene_data.h).
struct PackedScene {
  Bvh bvh;
  Words triangles, materials, texture_code, lights, tables;
  kernels::SceneData data{};
};

/// What an image that shines from infinity adds to the tables; offsets are from its first word.
struct InfiniteTables {
  std::vector<std::uint32_t> words;
  bool has_texels = false;  ///< at its start, in one word each
  std::uint32_t rows = 0, sines = 0, columns = 0, blocks = 0;
  double weight = 0;  ///< luminance over all directions
};

inline std::size_t bytes_held(const InfiniteTables& of) {
  return of.words.size() * sizeof(of.words[0]) + sizeof of;
}

/// An object's rows of `triangles`, without what ties mark them with.
struct TriangleRows {
  Words words;
};
inline std::size_t bytes_held(const TriangleRows& of) {
  return of.words.words().size() * sizeof(std::uint32_t) + sizeof of;
}

/// What packing made for scenes before, and what it depends on is the same: thousands of models
/// stand in one environment. Changes no word. Used by one thread at a time.
struct PackCache {
  /// `most_bytes` of each kind.
  explicit PackCache(std::size_t most_bytes)
      : trees(most_bytes), ties(most_bytes), rows(most_bytes), infinite(most_bytes) {}

  TreeCache trees;
  Kept<TiePairs> ties;
  Kept<TriangleRows> rows;
  Kept<InfiniteTables> infinite;
};

/// Images must be loaded. `effects` gives the numbers of materials, textures and lights: the
/// scene's own, or all_effects(). Throws Error(asset) for a scene without triangles or with what
/// the tracer cannot hold. `bvh_width`: build_bvh's.
PackedScene pack_scene(const Scene& scene, const SceneEffects& effects, BvhQuality quality,
                       int bvh_width = k_most_bvh_width, PackCache* cache = nullptr);

/// What planes read of a scene (first_hit.cl): tree and triangles. Loads no image and numbers
/// nothing: no triangle is part of a light.
PackedScene pack_surfaces(const Scene& scene, BvhQuality quality, int bvh_width = k_most_bvh_width,
                          PackCache* cache = nullptr);

/// A triangle's row number where objects stand one behind the other: index of the object's first
/// triangle.
std::vector<std::uint32_t> first_triangles(const Scene& scene);

/// Appends the lights' rows and tables and fills the light fields of `packed.data`.
/// `mesh_lights[o]` becomes the row of the light that object o is, or k_none. `cache` may be null.
void pack_lights(const Scene& scene, const SceneEffects& effects, PackCache* cache,
                 PackedScene& packed, std::vector<std::uint32_t>& mesh_lights);

}  // namespace ds

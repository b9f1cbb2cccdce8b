// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/device/scene_pack.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ds {

/// A ray as tracer/kernels/rays.cl reads it.
struct RayWords {
  float origin[3], direction[3], t_max;
};
/// The nearest thing a ray meets, as rays.cl writes it: a row of PackedScene::triangles, or k_none.
struct RayAnswer {
  float t, b1, b2;
  std::uint32_t triangle;
};
using TraceRays = std::function<std::vector<RayAnswer>(std::span<const RayWords>)>;

/// Light that surfaces of the model, seen by a light, threw on one that receives caustics.
struct Photon {
  Vec3 position;  ///< world, metres: where it fell on
  Vec3 source;    ///< the surface it came from last
  float power;    ///< luminance of its flux, in a unit that all photons of a scene share
};

/// At most `most` of them: as many start on the model's triangles that cast caustics, spread by
/// area, towards the lights in turn; what no light reaches, a BSDF sends nowhere or no receiving
/// surface meets is lost. A photon is kept at every receiving surface on its way and goes on where
/// that casts too, four times at most. A pure function of the scene, with the same bits on every
/// machine. Textured inputs of the model count as 0.5, or as 0.1 where they are one number: photons
/// say where to look, not what is there.
std::vector<Photon> trace_photons(const Scene& scene, const PackedScene& packed,
                                  const SceneEffects& effects, std::size_t most,
                                  const TraceRays& trace);

}  // namespace ds

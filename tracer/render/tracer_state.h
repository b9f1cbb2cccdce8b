// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/opencl.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/device_scene.h"
#include "tracer/render/guide_maker.h"
#include "tracer/render/path_programs.h"
#include "tracer/render/render.h"
#include "tracer/render/scene_maker.h"

#include <deque>
#include <optional>
#include <vector>

/// What is behind a Tracer; for tracer/render's own files.
namespace ds {

inline std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

struct Tracer::State {
  explicit State(const TracerOptions& o);

  /// Gets scene, guide and program of a picture ready. The packed scene depends on the effects
  /// (numbers), which may change from picture to picture.
  void prepare(const Camera& camera, const EngineSettings& engine,
               const std::vector<const PlaneType*>& light_planes = {});
  void forget_scene();
  const Scene& scene() const { return ready->scene; }
  /// The scene's words with these numbers: those made ready, or made now.
  PackedScene words_for(const SceneEffects& numbering);
  /// Uploads the scene; keeps what a guide will be made of. `numbering`: ReadyScene's.
  void take(PackedScene scene_words, const std::optional<SceneEffects>& numbering);
  /// Uploads at least what planes read.
  void take_surfaces();
  /// And what those read that ask for materials.
  void take_materials(const Camera& camera);
  /// Of the scene that is packed.
  std::vector<std::uint32_t> guide_words(std::size_t photons);
  /// Whether any light shines. In a scene where none does, no ray is traced.
  bool is_lit(const Camera& camera) const;
  /// Gives the path kernel a row of counts for each work-item, as its last argument.
  void start_counting(unsigned argument, std::size_t items);
  void add_counts();
  /// Pixels that a work-item takes: with 16 rays under way on a CPU, as many as a path tracer's 8 lanes
  /// have with their shadow rays, none waits for its next node.
  int plane_lanes() const { return options.lanes == 0 && device.info().is_cpu ? 16 : lanes; }
  Kernel& plane_kernel(const std::vector<const PlaneType*>& types);
  /// One launch for planes of one scene.
  std::vector<Plane> launch_planes(const DeviceScene& of, const Scene& seen, const Camera& camera,
                                   int width, int height,
                                   const std::vector<const PlaneType*>& types);
  SceneEffects effects(const Scene& of, const Camera& camera) const {
    SceneEffects own = scene_effects(of, camera);
    if (!options.full_program) return own;
    return full_effects(own);
  }

  TracerOptions options;
  Device device;
  int lanes;
  PathPrograms programs;  ///< ends before the device does
  std::size_t local_size = 8;
  SceneMaker maker;
  GuideMaker guides;
  std::optional<ReadyScene> ready;  ///< the scene set; its words until they are uploaded
  DeviceScene device_scene;
  bool on_device = false;  ///< it is this scene's
  UploadCounts uploads;
  std::optional<SceneEffects>
      packed_for;  ///< numbers on the device; none: no picture can be traced
  std::optional<SceneEffects> program_for;
  MathMode program_math = MathMode::strict;
  std::optional<PackedScene> packed;
  Buffer guide;
  std::optional<std::size_t> guide_photons;  ///< that `guide` is made of; none: of another scene
  Buffer count_rows;
  RayCounts ray_counts;
  Kernel path_kernel;
  std::optional<DeviceScene> device_model;  ///< the scene's model alone, once that was asked for
  struct PlaneKernel {
    std::vector<const PlaneType*> types;
    std::optional<SceneEffects> effects;  ///< where one of them reads materials
    Kernel kernel;
  };
  std::deque<PlaneKernel> plane_kernels;
  Buffer plane_numbers;  ///< what launch_planes writes to; as large as the largest so far
};

}  // namespace ds

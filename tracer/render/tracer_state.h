// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/opencl.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/device_scene.h"
#include "tracer/render/loaded_images.h"
#include "tracer/render/path_programs.h"
#include "tracer/render/render.h"

#include <deque>
#include <optional>
#include <vector>

/// What is behind a Tracer; for tracer/render's own files.
namespace ds {

/// Of images, and of what is made of scenes, that are kept for scenes to come.
inline constexpr std::size_t k_most_cached_bytes = std::size_t{256} << 20U;

inline std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

struct Tracer::State {
  explicit State(const TracerOptions& o);

  /// Gets scene, guide and program of a picture ready. The packed scene depends on the features
  /// (numbers), which may change from picture to picture.
  void prepare(const Camera& camera, const EngineSettings& engine,
               const std::vector<const PlaneType*>& light_planes = {});
  /// Uploads the scene; keeps what a guide will be made of.
  void take(PackedScene scene_words, const Features& numbering);
  std::vector<std::uint32_t> make_guide(std::size_t photon_count);
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
  Features features(const Scene& of, const Camera& camera) const {
    Features own = features_of(of, camera);
    if (!options.full_program) return own;
    Features all = all_features();
    all.chooser_depth = own.chooser_depth;
    return all;
  }
  BvhQuality quality() const {
    return options.high_quality_bvh ? BvhQuality::high : BvhQuality::medium;
  }

  TracerOptions options;
  Device device;
  int lanes;
  PathPrograms programs;  ///< ends before the device does
  std::size_t local_size = 8;
  std::optional<Scene> scene;
  LoadedImages images{k_most_cached_bytes};
  PackCache pack_cache{k_most_cached_bytes};
  DeviceScene device_scene;
  UploadCounts uploads;
  std::optional<Features> packed_for, program_for;
  MathMode program_math = MathMode::strict;
  std::optional<PackedScene> packed;
  Buffer guide;
  std::optional<std::size_t> guide_photons;  ///< that `guide` is made of; none: of another scene
  Kernel rays_kernel;
  bool has_rays_program = false;
  Buffer count_rows;
  RayCounts ray_counts;
  Kernel path_kernel;
  std::optional<DeviceScene> device_model;  ///< the scene's model alone, once that was asked for
  struct PlaneKernel {
    std::vector<const PlaneType*> types;
    std::optional<Features> features;  ///< where one of them reads materials
    Kernel kernel;
  };
  std::deque<PlaneKernel> plane_kernels;
};

}  // namespace ds

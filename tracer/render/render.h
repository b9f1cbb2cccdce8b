// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ds {

enum class MathMode { strict, fast };

/// Which pixels an error is of: all, or those whose centre shows the model (Geometry::mask); a
/// picture that shows none of it is looked at as a whole.
enum class ErrorRegion { image, model };

/// Samples until a picture is as exact as wanted, in place of the same number for every pixel.
struct ErrorTarget {
  double error = 0.02;  ///< largest upper end of the developed picture's error, see Schedule
  int max_spp = 1024;   ///< samples a pixel on the picture's average, 16 .. 2^24: the most it gets
  ToneMap tone_map{};   ///< what it is developed with
  ErrorRegion region = ErrorRegion::image;
};

/// Everything about how a picture is traced that is not scene or camera. All of it is in the render
/// key.
struct EngineSettings {
  int width = 512, height = 512;  ///< 1 .. 16384
  int spp = 64;                   ///< samples a pixel, 1 .. 2^24; not with a target
  std::optional<ErrorTarget> target{};
  int depth_total = 6;  ///< path vertices after the camera, >= 1 (LuxCore path.pathdepth.total)
  int depth_diffuse = 4, depth_glossy = 4, depth_specular = 6;
  int roulette_depth = 3;     ///< first vertex at which Russian roulette may end a path
  float roulette_cap = 0.5f;  ///< least survival probability, (0, 1]
  float filter_width = 3.0f;  ///< Blackman-Harris, full width in pixels; up to 1: a box of one
  std::uint64_t seed = 0;
  /// Samples with a component above this (linear radiance) are scaled down to it, which loses
  /// energy; 0 leaves every sample as it is.
  float outlier_limit = 0;
  MathMode math = MathMode::strict;
};

/// What is known of a film beside its pixels: a pure function of its samples, as the pixels are.
struct FilmFacts {
  std::uint64_t samples = 0;                  ///< camera samples, over all pixels
  std::uint32_t least_spp = 0, most_spp = 0;  ///< samples of the pixel with fewest and with most
  /// Samples that were not added, by the first of these that held for one of their components.
  std::uint64_t nan_samples = 0, infinite_samples = 0, negative_samples = 0;
  std::uint64_t outlier_samples = 0;  ///< scaled down to EngineSettings::outlier_limit
  double removed_energy = 0;  ///< luminance that this took, over the luminance there would be
  /// 95 % interval of the error this very film has, around Film::relative_error.
  std::optional<double> error_low{}, error_high{};
  /// With an error target: the developed picture's error that was reached and its 95 % interval
  /// (Schedule), and whether max_spp ended it before its upper end was the error wanted.
  std::optional<double> developed_error{}, developed_low{}, developed_high{};
  bool capped = false;

  bool operator==(const FilmFacts&) const = default;
};

/// Linear radiance, the mean over each pixel's samples. Row 0 is the top, left to right, three
/// floats a pixel.
struct Film {
  int width = 0, height = 0;
  std::vector<float> rgb;
  std::uint64_t rejected_samples = 0;  ///< NaN, infinite or negative: counted as black
  /// Estimated RMS error of the pixels' luminance over the mean luminance, from two independently
  /// scrambled halves of each pixel's samples (render/film_error.h). 0 for a black film; nothing
  /// for a single sample a pixel, which tells nothing of its error.
  std::optional<double> relative_error{};
  FilmFacts facts{};
  /// Half the difference between the means of the even and of the odd samples: rgb plus and minus
  /// this are two independent estimates. Three floats a pixel; empty where a pixel has one sample,
  /// and for films read from EXR files.
  std::vector<float> halves{};
  std::uint64_t traced_samples = 0;  ///< by the call that gave this film; it may have gone on
};

struct FilmSums;
struct PlaneType;

/// What one ray a pixel, through its centre and the pinhole (no lens), finds of its type; of a plane of
/// light, what all the picture's paths do, as the picture's film is made of them. Row 0 is the top,
/// left to right; `type->width` numbers a pixel, by their bits where they are words.
struct Plane {
  const PlaneType* type = nullptr;
  int width = 0, height = 0;
  std::vector<float> values;
};

/// One ray a pixel, through its centre and the pinhole (no lens). Row 0 is the top.
struct Geometry {
  int width = 0, height = 0;
  std::vector<std::uint8_t> mask;  ///< 255 where the model is the nearest thing hit, else 0
  std::vector<float> depth;  ///< planar z along the viewing axis in metres; 0 where nothing is hit
};

/// A picture's film and shares of it.
struct LitPlanes {
  Film film;
  std::vector<Plane> planes;
};

struct TraceProgress {
  std::uint64_t samples_done = 0;   ///< by this call
  std::uint64_t samples_total = 0;  ///< that it takes; at most, with an error target
};

/// How the tracer runs on one device; none of it may change a bit of a strict picture (tests hold
/// it to that).
struct TracerOptions {
  /// As `Device::Device` has it: "" = the preferred one; a number, a kind or part of a name selects.
  std::string device;
  int lanes = 0;            ///< N: 0 = see default_lanes; 1, 4, 8, 16
  int work_group_size = 0;  ///< 0 = 1 on CPUs, 64 on GPUs
  int item_pixels = 0;      ///< pixels a work-item takes; 0 = up to 128 on CPUs, one a lane on GPUs
  bool full_program = false;  ///< compile every effect in, used or not
  bool high_quality_bvh = false;
  int bvh_width = 8;         ///< most children of a node, 2 .. 8
  bool count_rays = false;   ///< see Tracer::ray_counts; costs a few percent
  bool plain_sums = false;   ///< samples are added in plain floats, to tell what compensating costs
  std::string cache_folder;  ///< compiled programs; "" = the user's cache folder
};

/// A tracer's path-tracing programs: one for each set of effects that its pictures called for.
struct ProgramCounts {
  std::uint64_t programs = 0;
  std::uint64_t compiled = 0;  ///< of these, not found among those of earlier processes
  std::uint64_t ahead = 0;     ///< of these, begun before a picture needed them
};

/// Rays that a picture's paths traced; a camera ray goes on behind an object that the camera does
/// not see as another one. `geometry`: of masks and depths, one a pixel.
struct RayCounts {
  std::uint64_t camera = 0, extension = 0, shadow = 0, geometry = 0;

  bool operator==(const RayCounts&) const = default;
};

/// What is to be traced of a scene. `planes`: such as ask for no material (reads_materials) and no
/// light.
enum class SceneUse { pictures, planes };

/// What the host makes of a scene before the device is asked (scene_maker.h).
struct ReadyScene;
struct ReadySceneDeleter {
  void operator()(ReadyScene* scene) const;
};
using ReadyScenePointer = std::unique_ptr<ReadyScene, ReadySceneDeleter>;

/// Tables of scenes that went to the device, and those that were there already.
struct UploadCounts {
  std::uint64_t tables = 0, bytes = 0;
  std::uint64_t kept_tables = 0, kept_bytes = 0;
};

/// Traces pictures on one device. Not safe from two threads at once, but for `make_ready`; use one
/// a thread.
/// Keeps the last scene's device data, so many cameras of one scene cost one upload, and what the
/// next scene has in common with it none.
class Tracer {
 public:
  /// Throws Error(device), or Error(usage) for options out of their range.
  explicit Tracer(const TracerOptions& options);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Takes the scene (images are loaded), checks its numbers (scene_check.h); trees and programs
  /// are built when the first picture needs them. Throws Error(asset) or Error(device).
  void set_scene(Scene scene);
  /// What set_scene and the first picture of these settings, or planes, then do before they launch
  /// anything: trees, tables, photons. From any thread, also while another one traces; nothing of
  /// what it gives depends on that. Throws what set_scene and preparing a picture throw.
  ReadyScenePointer make_ready(Scene scene, SceneUse use, const EngineSettings& engine);
  /// Takes a scene that this tracer made ready, for whatever use.
  void set_scene(ReadyScenePointer scene);
  /// Path-traces the scene set. Calls `progress` about twice a second; stops early with
  /// Error(cancelled) once `*stop`. `kept` is a film of this very picture that tracing goes on from
  /// where that gives the bits of one go (only samples and target may differ), else it is dropped;
  /// afterwards it is the film reached.
  Film trace(const Camera& camera, const EngineSettings& engine,
             const std::function<void(const TraceProgress&)>& progress = {},
             const std::atomic<bool>* stop = nullptr, FilmSums* kept = nullptr);
  /// The same film, and planes of light (is_of_light) of the same samples, in this order; each has the
  /// same bits whatever the others are. Kept films have none: it starts anew, `reached` is where it
  /// ends. By fast arithmetic the film's bits may be others.
  LitPlanes trace_light(const Camera& camera, const EngineSettings& engine,
                        const std::vector<const PlaneType*>& types,
                        const std::function<void(const TraceProgress&)>& progress = {},
                        const std::atomic<bool>* stop = nullptr, FilmSums* reached = nullptr);
  /// Packs the scene set and gets its program; `trace` does so where it was not done.
  void prepare(const Camera& camera, const EngineSettings& engine,
               const std::vector<const PlaneType*>& light_planes = {});
  /// Starts to get the program of a later picture ready in a thread of its own, which goes on while
  /// `trace` runs. Of the scene only what `scene_effects` looks at matters. False, at once, where the
  /// program is known already.
  bool prepare_ahead(const Scene& scene, const Camera& camera, const EngineSettings& engine,
                     const std::vector<const PlaneType*>& light_planes = {});
  ProgramCounts programs() const;
  UploadCounts uploads() const;
  /// Of all pictures and geometry traced, where TracerOptions::count_rays was set; else none.
  RayCounts ray_counts() const;
  /// Of these types, which ask no light, in this order; each has the same bits whatever the others are.
  std::vector<Plane> trace_planes(const Camera& camera, int width, int height,
                                  const std::vector<const PlaneType*>& types);
  /// The amodal mask of each of the scene's objects of these ids, as if it were alone: Plane::type is that
  /// of the model's.
  std::vector<Plane> trace_alone(const Camera& camera, int width, int height,
                                 const std::vector<std::uint32_t>& ids);
  /// The planes mask and depth.
  Geometry trace_geometry(const Camera& camera, int width, int height);
  std::string device_name() const;
  /// Whether the device is this machine's processors: their time is then this process' own.
  bool runs_on_cpu() const;

 private:
  std::vector<std::uint8_t> error_region(const Camera& camera, const EngineSettings& engine);
  class PictureLaunches;
  Film finish(PictureLaunches& picture, const Camera& camera, const EngineSettings& engine,
              const std::function<void(const TraceProgress&)>& progress);

  struct State;
  std::unique_ptr<State> state_;
};

/// Canonical text of the engine part of the render key: the settings, and the comment-stripped text
/// of the program specialised for this scene and camera. Works without any OpenCL device.
std::string canonical_engine(const Scene& scene, const Camera& camera,
                             const EngineSettings& engine);
/// The same less what only says when to stop (spp; error and max_spp): pictures that agree in this
/// go on from each other's films.
std::string canonical_kept_engine(const Scene& scene, const Camera& camera,
                                  const EngineSettings& engine);
/// Canonical text of the camera part.
std::string canonical_camera(const Camera& camera);
/// Bumped when host code that can move a pixel changes (mesh normalisation, packing, sky model,
/// sampling tables, the guide to caustics).
inline constexpr int k_host_render_version = 10;

}  // namespace ds

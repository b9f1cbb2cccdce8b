// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"
#include "tracer/device/scene_pack.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/film.h"
#include "tracer/render/guide.h"
#include "tracer/render/images.h"
#include "tracer/render/path_programs.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/render.h"
#include "tracer/render/schedule.h"
#include "tracer/render/view.h"
#include "tracer/scene/scene_check.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace ds {
namespace {

using Clock = std::chrono::steady_clock;

/// A scene's tables in device memory.
struct DeviceScene {
  Buffer nodes, leaves, triangles, materials, programs, lights, tables, data;
};

DeviceScene upload(const Device& device, const PackedScene& packed) {
  DeviceScene s;
  s.nodes = device.upload(packed.bvh.nodes);
  s.leaves = device.upload(packed.bvh.leaves);
  s.triangles = device.upload(packed.triangles.words());
  s.materials = device.upload(packed.materials.words());
  s.programs = device.upload(packed.programs.words());
  s.lights = device.upload(packed.lights.words());
  s.tables = device.upload(packed.tables.words());
  s.data = device.upload(std::as_bytes(std::span(&packed.data, 1)));
  return s;
}

std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

/// Two for each pixel, so that a small picture is not longer under way for them than for its own
/// samples. Not by spp: more samples go on from a kept film.
std::size_t photons_for(const EngineSettings& engine) {
  const std::size_t pixels =
      static_cast<std::size_t>(engine.width) * static_cast<std::size_t>(engine.height);
  return std::clamp(2 * pixels, std::size_t{1} << 14, std::size_t{1} << 17);
}

/// What the kernel reads of a launch (kernels/film_data.h).
std::vector<std::uint32_t> launch_words(const FilmSums& film, std::span<const TileStep> steps,
                                        std::size_t share) {
  std::vector<std::uint32_t> words{static_cast<std::uint32_t>(share),
                                   static_cast<std::uint32_t>(steps.size())};
  for (const TileStep& step : steps) {
    words.push_back(static_cast<std::uint32_t>(step.tile));
    words.push_back(film.tile_spp[step.tile]);
    words.push_back(step.end);
  }
  return words;
}

/// Whether tracing on from a kept film gives the bits of one go.
bool goes_on(const EngineSettings& engine, const FilmSums& film) {
  if (film.empty() || film.width != engine.width || film.height != engine.height) return false;
  if (engine.target) return Schedule::comes_by(*engine.target, film);
  const auto [least, most] = std::minmax_element(film.tile_spp.begin(), film.tile_spp.end());
  return *least == *most && *most <= static_cast<std::uint32_t>(engine.spp) &&
         !film.schedule.tone_scale;
}

}  // namespace

struct Tracer::State {
  explicit State(const TracerOptions& o)
      : options(o),
        device(o.device),
        lanes(o.lanes != 0 ? o.lanes : default_lanes(device.info())),
        programs(device,
                 fmt::format("-DDS_LANES={}{}{}", lanes, o.count_rays ? " -DDS_COUNT_RAYS" : "",
                             o.plain_sums ? " -DDS_PLAIN_SUMS" : ""),
                 o.cache_folder) {
    if (options.bvh_width < k_least_bvh_width || options.bvh_width > k_most_bvh_width)
      fail(ErrorKind::usage, "bvh_width must be in [{}, {}], got {}", k_least_bvh_width,
           k_most_bvh_width, options.bvh_width);
    // A CPU's threads take groups as they get done: small ones share a launch out evenly. A GPU
    // runs a group's items side by side.
    local_size = options.work_group_size != 0 ? static_cast<std::size_t>(options.work_group_size)
                 : device.info().is_cpu       ? 1
                                              : 64;
  }

  /// The packed scene depends on the features (numbers), which may change from picture to picture.
  void prepare(const Camera& camera, const EngineSettings& engine) {
    if (!scene) fail(ErrorKind::device, "no scene was set before tracing");
    const Features wanted = features(*scene, camera);
    // The lens changes the program, not the numbers in the tables.
    Features numbering = wanted;
    numbering.lens = false;
    const std::size_t photons = wanted.guide ? photons_for(engine) : 0;
    const bool lacks_photons = guide_photons != photons && photons > 0 && !packed;
    if (!packed_for || *packed_for != numbering || lacks_photons)
      take(pack_scene(*scene, wanted, quality(), options.bvh_width), numbering);
    if (guide_photons != photons) {
      guide = device.upload(photons > 0 ? make_guide(photons) : std::vector<std::uint32_t>(1));
      guide_photons = photons;
      packed.reset();
    }
    if (!program_for || *program_for != wanted || program_math != engine.math) {
      path_kernel = device.kernel(programs.get(wanted, engine.math), "trace_paths");
      program_for = wanted;
      program_math = engine.math;
    }
  }

  /// Uploads the scene; keeps what a guide will be made of.
  void take(PackedScene scene_words, const Features& numbering) {
    device_scene = upload(device, scene_words);
    packed_for = numbering;
    guide_photons.reset();
    if (numbering.guide) packed = std::move(scene_words);
  }

  std::vector<std::uint32_t> make_guide(std::size_t photon_count) {
    if (!has_rays_program) {
      rays_kernel =
          device.kernel(device.build(rays_program_text(), k_strict_options, options.cache_folder),
                        "trace_nearest");
      has_rays_program = true;
    }
    const TraceRays trace_rays = [&](std::span<const RayWords> rays) {
      const std::size_t count = round_up(std::max<std::size_t>(rays.size(), 1), 64);
      std::vector<RayWords> padded(rays.begin(), rays.end());
      padded.resize(count, RayWords{{0, 0, 0}, {0, 0, 1}, 0});
      const Buffer in = device.upload(padded);
      const Buffer out = device.make_buffer(count * sizeof(RayAnswer));
      rays_kernel.set(0, device_scene.nodes);
      rays_kernel.set(1, device_scene.leaves);
      rays_kernel.set(2, in);
      rays_kernel.set(3, out);
      device.run(rays_kernel, 0, count, 64);
      std::vector<RayAnswer> answers(rays.size());
      device.read(out, std::as_writable_bytes(std::span(answers)));
      return answers;
    };
    const std::vector<Photon> photons =
        trace_photons(*scene, *packed, *packed_for, photon_count, trace_rays);
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    for (const Object& object : scene->objects) {
      if (object.id != k_model_object_id) continue;
      for (const Vec3& p : object.mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    const Vec3 half = 0.5f * (high - low);
    return guide_table(photons, low + half, std::sqrt(dot(half, half)));
  }

  /// Whether any light shines. In a scene where none does, no ray is traced.
  bool is_lit(const Camera& camera) const { return !features_of(*scene, camera).lights.empty(); }

  /// Gives the kernel a row of counts for each work-item, as its last argument.
  void start_counting(unsigned argument, std::size_t items) {
    if (!options.count_rays) return;
    count_rows = device.make_buffer(items * kernels::k_ray_counts * sizeof(std::uint32_t));
    device.fill_zero(count_rows);
    path_kernel.set(argument, count_rows);
  }
  void add_counts() {
    if (!options.count_rays) return;
    std::vector<std::uint32_t> words(count_rows.size_bytes() / sizeof(std::uint32_t));
    device.read(count_rows, std::as_writable_bytes(std::span(words)));
    for (std::size_t i = 0; i < words.size(); i += kernels::k_ray_counts) {
      ray_counts.camera += words[i + kernels::k_count_camera];
      ray_counts.extension += words[i + kernels::k_count_extension];
      ray_counts.shadow += words[i + kernels::k_count_shadow];
    }
  }

  Features features(const Scene& of, const Camera& camera) const {
    return options.full_program ? all_features() : features_of(of, camera);
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
  DeviceScene device_scene;
  std::optional<Features> packed_for, program_for;
  MathMode program_math = MathMode::strict;
  std::optional<PackedScene> packed;
  Buffer guide;
  std::optional<std::size_t> guide_photons;  ///< that `guide` is made of; none: of another scene
  Kernel rays_kernel;
  bool has_rays_program = false;
  Program geometry_program;
  Buffer count_rows;
  RayCounts ray_counts;
  Kernel path_kernel, geometry_kernel;
  bool has_geometry_program = false;
};

Tracer::Tracer(const TracerOptions& options) : state_(std::make_unique<State>(options)) {}
Tracer::~Tracer() = default;

std::string Tracer::device_name() const {
  return state_->device.info().name;
}

bool Tracer::runs_on_cpu() const {
  return state_->device.info().is_cpu;
}

void Tracer::set_scene(const Scene& scene) {
  state_->scene.reset();
  state_->packed_for.reset();
  Scene checked = scene;
  load_images(checked);
  check_scene(checked);
  state_->scene = std::move(checked);
}

void Tracer::prepare(const Camera& camera, const EngineSettings& engine) {
  state_->prepare(camera, engine);
}

bool Tracer::prepare_ahead(const Scene& scene, const Camera& camera, const EngineSettings& engine) {
  return state_->programs.make_ahead(state_->features(scene, camera), engine.math);
}

ProgramCounts Tracer::programs() const {
  return state_->programs.counts();
}

RayCounts Tracer::ray_counts() const {
  return state_->ray_counts;
}

/// One picture under way: its film on the device, and how it gets more samples.
class Tracer::Picture {
 public:
  Picture(State& state, const Camera& camera, const EngineSettings& engine, FilmSums film,
          const std::atomic<bool>* stop)
      : s_(state), film_(std::move(film)), stop_(stop) {
    const kernels::ViewData view =
        view_data(camera, engine, ray_start_m(*s_.scene, camera, engine.width, engine.height));
    view_ = s_.device.upload(std::as_bytes(std::span(&view, 1)));
    sums_ = s_.device.upload(film_.planes);
    const DeviceScene& t = s_.device_scene;
    unsigned argument = 0;
    const Buffer &v = view_, &guide = s_.guide;
    for (const Buffer* b : {&t.nodes, &t.leaves, &t.triangles, &t.materials, &t.programs, &t.lights,
                            &t.tables, &t.data, &guide, &v})
      s_.path_kernel.set(argument++, *b);
    launch_argument_ = argument;
    s_.path_kernel.set(argument + 1, sums_);
    lit_ = s_.is_lit(camera);
  }

  FilmSums& film() { return film_; }

  /// Traces the steps in launches of about half a second: often enough to report and to stop.
  /// `progress` gets the samples done of these steps.
  void add(std::span<const TileStep> steps, const std::function<void(std::uint64_t)>& progress);

 private:
  struct Launch {
    std::size_t items = 0;
    std::uint64_t samples = 0;
  };
  std::size_t share_of(std::span<const TileStep> steps) const;
  Launch next_launch(std::span<const TileStep> steps, std::size_t share, std::size_t begin,
                     std::size_t items) const;

  State& s_;
  FilmSums film_;
  const std::atomic<bool>* stop_;
  Buffer view_, sums_;
  unsigned launch_argument_ = 0;
  bool lit_ = true;
  double samples_a_second_ = 0;  ///< of the last launch
};

/// How many pixels a work-item takes, if the options leave it open: on a CPU as many as leave eight
/// work-items for each processor, up to eight tiles: lanes idle only when no pixel is left for
/// them. Fewer where pixels have thousands of samples, which keep lanes busy by themselves: a
/// launch is to end soon after it is to stop. A GPU has threads for all.
std::size_t Tracer::Picture::share_of(std::span<const TileStep> steps) const {
  if (s_.options.item_pixels > 0) return static_cast<std::size_t>(s_.options.item_pixels);
  if (!s_.device.info().is_cpu) return static_cast<std::size_t>(s_.lanes);
  constexpr std::size_t most_samples = 4096;  // of a pixel of each tile
  std::size_t most_spp = 1;
  for (const TileStep& step : steps)
    most_spp = std::max<std::size_t>(most_spp, step.end - film_.tile_spp[step.tile]);
  const std::size_t items = 8 * std::max<std::size_t>(s_.device.info().compute_units, 1);
  const std::size_t tiles =
      std::min({steps.size() / items, most_samples / most_spp, std::size_t{8}});
  return std::max<std::size_t>(tiles, 1) * kernels::k_tile_pixels;
}

/// Work-items from `begin` on that take about half a second, or some for each processor where
/// nothing is known of their time yet.
Tracer::Picture::Launch Tracer::Picture::next_launch(std::span<const TileStep> steps,
                                                     std::size_t share, std::size_t begin,
                                                     std::size_t items) const {
  const std::size_t least =
      s_.local_size * std::max<std::size_t>(s_.device.info().compute_units, 1) * 8;
  const double wanted = 0.5 * samples_a_second_;
  Launch launch;
  while (begin + launch.items < items &&
         (launch.items < least || static_cast<double>(launch.samples) < wanted)) {
    const std::size_t first = (begin + launch.items) * share;
    launch.items += s_.local_size;
    const std::size_t last = (begin + launch.items) * share;
    for (std::size_t i = first; i < std::min(last, steps.size() * kernels::k_tile_pixels); ++i) {
      const TileStep& step = steps[i / kernels::k_tile_pixels];
      launch.samples += step.end - film_.tile_spp[step.tile];
    }
  }
  return launch;
}

void Tracer::Picture::add(std::span<const TileStep> steps,
                          const std::function<void(std::uint64_t)>& progress) {
  if (steps.empty()) return;
  const std::size_t share = share_of(steps);
  const std::size_t pixels = steps.size() * kernels::k_tile_pixels;
  const std::size_t items = round_up((pixels + share - 1) / share, s_.local_size);
  const Buffer words = s_.device.upload(launch_words(film_, steps, share));
  s_.path_kernel.set(launch_argument_, words);
  s_.start_counting(launch_argument_ + 2, items);
  std::uint64_t samples = 0;
  for (const TileStep& step : steps)
    samples += std::uint64_t{step.end - film_.tile_spp[step.tile]} * film_.tile_pixels(step.tile);
  for (std::size_t begin = 0; begin < items;) {
    if (stop_ != nullptr && stop_->load()) fail(ErrorKind::cancelled, "stopped");
    const Launch launch = next_launch(steps, share, begin, items);
    const auto before = Clock::now();
    if (lit_) s_.device.run(s_.path_kernel, begin, launch.items, s_.local_size);
    const std::chrono::duration<double> seconds = Clock::now() - before;
    samples_a_second_ = static_cast<double>(launch.samples) / std::max(seconds.count(), 1e-4);
    begin += launch.items;
    progress(samples * begin / items);
  }
  s_.add_counts();
  s_.device.read(sums_, std::as_writable_bytes(std::span(film_.planes)));
  for (const TileStep& step : steps)
    film_.tile_spp[step.tile] = step.end;
}

/// The pixels that the picture's error is of, for Schedule.
std::vector<std::uint8_t> Tracer::error_region(const Camera& camera, const EngineSettings& engine) {
  if (engine.target->region == ErrorRegion::image) return {};
  std::vector<std::uint8_t> mask = trace_geometry(camera, engine.width, engine.height).mask;
  const bool shown = std::any_of(mask.begin(), mask.end(), [](std::uint8_t m) { return m != 0; });
  return shown ? mask : std::vector<std::uint8_t>{};
}

Film Tracer::trace(const Camera& camera, const EngineSettings& engine,
                   const std::function<void(const TraceProgress&)>& progress,
                   const std::atomic<bool>* stop, FilmSums* kept) {
  state_->prepare(camera, engine);
  FilmSums begun = kept != nullptr ? std::move(*kept) : FilmSums{};
  if (!goes_on(engine, begun)) begun = empty_film(engine.width, engine.height);
  const std::uint64_t before = begun.samples();
  Picture picture(*state_, camera, engine, std::move(begun), stop);
  const int most = engine.target ? engine.target->max_spp : engine.spp;
  const std::uint64_t total = picture.film().pixels() * static_cast<std::uint64_t>(most) - before;
  const auto trace_steps = [&](const std::vector<TileStep>& steps) {
    const std::uint64_t base = picture.film().samples() - before;
    picture.add(steps, [&](std::uint64_t done) {
      if (progress) progress({base + done, total});
    });
  };
  const PixelFilter filter(engine.filter_width);
  Film film;
  if (engine.target) {
    Schedule schedule(*engine.target, picture.film(), filter, error_region(camera, engine));
    for (auto steps = schedule.next(); !steps.empty(); steps = schedule.next()) {
      trace_steps(steps);
      schedule.traced(steps);
    }
    picture.film().schedule = schedule.state();
    film = film_of(picture.film(), filter);
    const ErrorEstimate error = schedule.error();
    film.facts.developed_error = error.value;
    film.facts.developed_low = error.low;
    film.facts.developed_high = error.high;
    film.facts.capped = error.high > engine.target->error;
  } else {
    trace_steps(steps_to(picture.film(), static_cast<std::uint32_t>(engine.spp)));
    film = film_of(picture.film(), filter);
  }
  film.traced_samples = picture.film().samples() - before;
  if (kept != nullptr) *kept = std::move(picture.film());
  return film;
}

Geometry Tracer::trace_geometry(const Camera& camera, int width, int height) {
  State& s = *state_;
  if (!s.scene) fail(ErrorKind::device, "no scene was set before tracing");
  if (!s.packed_for) {
    // Any numbering will do: mask and depth ask no material.
    Features features = features_of(*s.scene, camera);
    features.lens = false;
    s.take(pack_scene(*s.scene, features, s.quality(), s.options.bvh_width), features);
  }
  if (!s.has_geometry_program) {
    s.geometry_program =
        s.device.build(geometry_program_text(), k_strict_options, s.options.cache_folder);
    s.geometry_kernel = s.device.kernel(s.geometry_program, "trace_geometry");
    s.has_geometry_program = true;
  }
  EngineSettings size;
  size.width = width;
  size.height = height;
  const kernels::ViewData view =
      view_data(camera, size, ray_start_m(*s.scene, camera, width, height));
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const Buffer view_buffer = s.device.upload(std::as_bytes(std::span(&view, 1)));
  const Buffer objects = s.device.make_buffer(pixels * sizeof(std::uint32_t));
  const Buffer depths = s.device.make_buffer(pixels * sizeof(float));
  Kernel& k = s.geometry_kernel;
  k.set(0, s.device_scene.nodes);
  k.set(1, s.device_scene.leaves);
  k.set(2, s.device_scene.triangles);
  k.set(3, view_buffer);
  k.set(4, objects);
  k.set(5, depths);
  s.device.run(k, 0, round_up(pixels, s.local_size), s.local_size);
  if (s.options.count_rays) s.ray_counts.geometry += pixels;
  Geometry geometry{width, height, std::vector<std::uint8_t>(pixels), std::vector<float>(pixels)};
  std::vector<std::uint32_t> ids(pixels);
  s.device.read(objects, std::as_writable_bytes(std::span(ids)));
  s.device.read(depths, std::as_writable_bytes(std::span(geometry.depth)));
  for (std::size_t i = 0; i < pixels; ++i)
    geometry.mask[i] = ids[i] == k_model_object_id ? 255 : 0;
  return geometry;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Writes a pack of launches and what they must give, for GPUs on machines without this project
// (ci/gpu; recorder.h says what a pack is):
//
//   gpu_pack FOLDER ASSETS [CASE...]
//   gpu_pack --list ASSETS             names the cases of pictures
//
// All cases, or those named. They are traced on this machine's first CPU device as GPUs are asked
// to: one path a work-item, groups of 64.
#include "tests/bench/ray_scene.h"
#include "tests/gpu/cases.h"
#include "tests/gpu/recorder.h"
#include "tracer/accel/bvh.h"
#include "tracer/base/error.h"
#include "tracer/device/opencl.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {
namespace {

constexpr std::size_t k_group = 64;
constexpr int k_ray_picture_size = 512;  // its pixels fill groups

/// Cases that were asked for, and which of them there are.
class Wanted {
 public:
  explicit Wanted(std::span<char*> names)
      : left_(names.begin(), names.end()), all_(left_.empty()) {}

  bool take(const std::string& name) {
    if (all_) return true;
    const auto found = std::find(left_.begin(), left_.end(), name);
    if (found == left_.end()) return false;
    left_.erase(found);
    return true;
  }
  void check_all_taken() const {
    if (!left_.empty()) fail(ErrorKind::usage, "there is no case {}", left_.front());
  }

 private:
  std::vector<std::string> left_;
  bool all_;
};

TracerOptions as_on_a_gpu() {
  TracerOptions options = pictures::tracer_options();
  options.device = "cpu";
  options.lanes = options.item_pixels = 1;
  options.work_group_size = static_cast<int>(k_group);
  return options;
}

void record(Tracer& tracer, const gpu::Case& one) {
  const pictures::Picture& picture = one.picture;
  const EngineSettings& engine = picture.engine;
  gpu::begin_case(picture.name);
  const auto pixels =
      static_cast<std::uint64_t>(engine.width) * static_cast<std::uint64_t>(engine.height);
  const bool geometry_alone = one.traces == gpu::Traces::geometry;
  if (one.timed && geometry_alone) gpu::time_case(pixels, "rays", "trace_planes");
  if (one.timed && !geometry_alone)
    gpu::time_case(pixels * static_cast<std::uint64_t>(engine.spp), "samples", "trace_paths");
  tracer.set_scene(picture.scene);
  const bool of_light = one.traces == gpu::Traces::light;
  if (of_light || one.traces == gpu::Traces::planes) {
    std::vector<const PlaneType*> types;
    for (const PlaneType& type : plane_types())
      if (is_of_light(type) == of_light) types.push_back(&type);
    if (of_light)
      tracer.trace_light(picture.camera, engine, types);
    else
      tracer.trace_planes(picture.camera, engine.width, engine.height, types);
    return gpu::end_case();
  }
  if (!geometry_alone) tracer.trace(picture.camera, engine);
  if (one.traces != gpu::Traces::picture)
    tracer.trace_geometry(picture.camera, engine.width, engine.height);
  gpu::end_case();
}

/// Traces rays one by one on the device; gives the words that the kernel answers, `words` a ray.
class RayTracer {
 public:
  explicit RayTracer(const std::vector<Corners>& triangles)
      : device_("cpu"),
        program_(device_.build(rays_program_text(),
                               fmt::format("{} -DDS_LANES=1", k_strict_options), DS_TEST_PROGRAMS)),
        bvh_(build_bvh(triangles)) {}

  std::vector<std::uint32_t> trace(const char* function, const std::vector<RayWords>& rays,
                                   std::size_t words) {
    Kernel kernel = device_.kernel(program_, function);
    std::vector<std::uint32_t> answers(rays.size() * words);
    const Buffer out = device_.make_buffer(answers.size() * sizeof(std::uint32_t));
    // A kernel does not keep its buffers.
    const Buffer nodes = device_.upload(bvh_.nodes), leaves = device_.upload(bvh_.leaves);
    const Buffer in = device_.upload(rays);
    unsigned argument = 0;
    for (const Buffer* buffer : {&nodes, &leaves, &in, &out})
      kernel.set(argument++, *buffer);
    device_.run(kernel, 0, rays.size(), k_group);
    device_.read(out, std::as_writable_bytes(std::span(answers)));
    return answers;
  }

  /// The same as a case.
  void record(const std::string& name, const char* function, const std::vector<RayWords>& rays,
              std::size_t words) {
    gpu::begin_case(name);
    gpu::time_case(rays.size(), "rays", function);
    trace(function, rays, words);
    gpu::end_case();
  }

 private:
  Device device_;
  Program program_;
  Bvh bvh_;
};

void record_ray_cases(Wanted& wanted) {
  const bool camera = wanted.take("rays-camera"), bounce = wanted.take("rays-bounce"),
             shadow = wanted.take("rays-shadow");
  if (!camera && !bounce && !shadow) return;
  const std::vector<Corners> triangles = ray_scene();
  RayTracer tracer(triangles);
  const std::vector<RayWords> rays = camera_rays(k_ray_picture_size);
  const std::vector<std::uint32_t> hits = tracer.trace("trace_nearest", rays, 4);
  std::vector<Met> met;  // trace_nearest answers t, b1, b2, id
  for (std::size_t i = 0; i < hits.size(); i += 4)
    met.push_back({std::bit_cast<float>(hits[i]), hits[i + 3], hits[i + 3] != ~0u});
  std::vector<RayWords> bounces = bounce_rays(triangles, rays, met);
  bounces.resize(bounces.size() / k_group * k_group);
  if (camera) tracer.record("rays-camera", "trace_nearest", rays, 4);
  if (bounce) tracer.record("rays-bounce", "trace_nearest", bounces, 4);
  if (shadow) tracer.record("rays-shadow", "trace_any", bounces, 1);
}

void run(std::span<char*> arguments) {
  if (arguments.size() == 3 && std::string_view(arguments[1]) == "--list") {
    for (const gpu::Case& one : gpu::all_cases(arguments[2]))
      fmt::print("{}\n", one.picture.name);
    return;
  }
  if (arguments.size() < 3) fail(ErrorKind::usage, "wanted FOLDER ASSETS [CASE...]");
  Wanted wanted(arguments.subspan(3));
  for (const gpu::Case& one : gpu::all_cases(arguments[2]))
    if (wanted.take(one.picture.name)) {
      fmt::print(stderr, "{}\n", one.picture.name);
      TracerOptions options = as_on_a_gpu();
      if (one.change) one.change(options);
      // A new one, for a tracer keeps tables that two scenes share, and a case writes all of its own.
      Tracer tracer(options);
      if (!tracer.runs_on_cpu()) fail(ErrorKind::device, "no CPU device to trace on");
      record(tracer, one);
    }
  record_ray_cases(wanted);
  wanted.check_all_taken();
  gpu::write_pack(arguments[1]);
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    ds::run({arguments, static_cast<std::size_t>(count)});
    return 0;
  } catch (const ds::Error& error) {
    fmt::print(stderr, "gpu_pack: {}\n", error.what());
    return ds::exit_code(error.kind());
  }
}

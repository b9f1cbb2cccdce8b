// SPDX-License-Identifier: Apache-2.0
// Closest hits a second: trace_batches of tracer/kernels/rays.cl on the OpenCL device, sixteen rays
// by turns as the path tracer has them in flight, beside Embree's rtcIntersect1,
// the same rays in the same run, turn by turn.
//
//   ray_bench [REPEATS [CAMERA_SIZE]]
//
// Prints one JSON object: per kind of ray the Mrays/s of every repeat of both, and the share of
// rays on which both name the same triangle (they differ in ties and along edges).
#include "tests/bench/embree_tracer.h"
#include "tests/bench/ray_scene.h"
#include "tracer/accel/bvh.h"
#include "tracer/base/error.h"
#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <functional>
#include <span>
#include <string>

namespace ds {
namespace {

using nlohmann::json;

constexpr std::size_t k_local_size = 8;
/// Rays of a batch: the most that the path tracer has in flight on a CPU.
constexpr std::size_t k_lanes = 16;
/// Each timing traces its rays this often, so that it lasts a tenth of a second and more.
constexpr int k_rounds = 10;

/// dsbuild's side: the kernel trace_batches over rays in device memory.
class KernelTracer {
 public:
  explicit KernelTracer(const std::vector<Corners>& triangles) : device_("") {
    const Bvh bvh = build_bvh(triangles);
    nodes_ = device_.upload(bvh.nodes);
    leaves_ = device_.upload(bvh.leaves);
    kernel_ = device_.kernel(
        device_.build(rays_program_text(),
                      fmt::format("{} -DDS_LANES={}", k_strict_options, k_lanes), {}),
        "trace_batches");
  }

  const DeviceInfo& info() const { return device_.info(); }

  void set_rays(const std::vector<RayWords>& rays) {
    count_ = rays.size();
    hits_ = device_.make_buffer(count_ * 2 * sizeof(float));
    kernel_.set(0, nodes_);
    kernel_.set(1, leaves_);
    kernel_.set(2, device_.upload(rays));
    kernel_.set(3, std::uint32_t{0});
    kernel_.set(4, hits_);
    kernel_.set(5, hits_);
  }
  void trace() const { device_.run(kernel_, 0, count_ / k_lanes, k_local_size); }

  std::vector<Met> met() const {
    std::vector<std::array<std::uint32_t, 2>> words(count_);
    device_.read(hits_, std::as_writable_bytes(std::span(words)));
    std::vector<Met> result;
    for (const auto& w : words)
      result.push_back({std::bit_cast<float>(w[0]), w[1], w[1] != ~0u});
    return result;
  }

 private:
  Device device_;
  Buffer nodes_, leaves_, hits_;
  Kernel kernel_;
  std::size_t count_ = 0;
};

double mrays_per_second(std::size_t rays, const std::function<void()>& trace) {
  const auto begin = std::chrono::steady_clock::now();
  for (int round = 0; round < k_rounds; ++round)
    trace();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  return 1e-6 * k_rounds * static_cast<double>(rays) / seconds.count();
}

json compare(KernelTracer& kernel, const EmbreeTracer& embree, std::vector<RayWords> rays,
             int repeats) {
  rays.resize(rays.size() / (k_local_size * k_lanes) * (k_local_size * k_lanes));
  std::vector<Met> met(rays.size());
  kernel.set_rays(rays);
  kernel.trace();
  embree.trace(rays, met);
  const std::vector<Met> ours = kernel.met();
  std::size_t agreed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    agreed += ours[i].any == met[i].any && (!met[i].any || ours[i].triangle == met[i].triangle);

  json dsbuild_rates = json::array(), embree_rates = json::array();
  for (int i = 0; i < repeats; ++i) {
    dsbuild_rates.push_back(mrays_per_second(rays.size(), [&] { kernel.trace(); }));
    embree_rates.push_back(mrays_per_second(rays.size(), [&] { embree.trace(rays, met); }));
  }
  return {{"rays", rays.size()},
          {"dsbuild", dsbuild_rates},
          {"embree", embree_rates},
          {"same_triangle", static_cast<double>(agreed) / static_cast<double>(rays.size())}};
}

void run(int count, char** arguments) {
  const int repeats = count > 1 ? std::stoi(arguments[1]) : 9;
  const int size = count > 2 ? std::stoi(arguments[2]) : 512;
  const std::vector<Corners> triangles = ray_scene();
  KernelTracer kernel(triangles);
  const EmbreeTracer embree(triangles);

  const std::vector<RayWords> camera = camera_rays(size);
  std::vector<Met> met(camera.size());
  embree.trace(camera, met);
  const json result = {
      {"device", kernel.info().name},
      {"threads", embree.threads()},
      {"compute_units", kernel.info().compute_units},
      {"triangles", triangles.size()},
      {"camera", compare(kernel, embree, camera, repeats)},
      {"bounce", compare(kernel, embree, bounce_rays(triangles, camera, met), repeats)}};
  fmt::print("{}\n", result.dump());
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    ds::run(count, arguments);
    return 0;
  } catch (const ds::Error& error) {
    fmt::print(stderr, "ray_bench: {}\n", error.what());
    return ds::exit_code(error.kind());
  }
}

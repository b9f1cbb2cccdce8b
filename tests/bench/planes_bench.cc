// SPDX-License-Identifier: Apache-2.0
// Pixels a second of planes that ask no light, beside Embree's rtcIntersect1 on the same rays of the
// same view, on as many threads, turn by turn.
//
//   planes_bench MODEL MATERIAL ENVIRONMENT [SIZE [REPEATS]]
//
// dsbuild's figures are of whole calls, from a camera to planes in the host's memory; Embree's side
// makes each ray, traces it and writes depth and mask. Its tree and ours are built before. Prints a
// table: medians, least and greatest, by the clock and by the processor time of all threads.
#include "tests/bench/embree_tracer.h"
#include "tracer/base/error.h"
#include "tracer/device/plane_types.h"
#include "tracer/render/images.h"
#include "tracer/render/render.h"
#include "tracer/render/view.h"
#include "tracer/scene/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

namespace ds {
namespace {

/// Each timing makes its planes this often, so that it lasts a tenth of a second and more.
constexpr int k_rounds = 8;

struct Rates {
  std::vector<double> wall, processor;  ///< million pixels a second
};

struct Contender {
  std::string name;
  std::function<void()> run;
  Rates rates;
};

void measure(Contender& one, double pixels) {
  const std::clock_t processor = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  for (int round = 0; round < k_rounds; ++round)
    one.run();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const double busy = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  one.rates.wall.push_back(1e-6 * k_rounds * pixels / seconds.count());
  one.rates.processor.push_back(1e-6 * k_rounds * pixels / busy);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::string spread(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{:6.2f} ({:.2f} to {:.2f})", median(values), *least, *most);
}

/// Turn by turn.
std::string ratio(const std::vector<double>& ours, const std::vector<double>& theirs) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.size(); ++i)
    ratios.push_back(ours[i] / theirs[i]);
  return spread(ratios);
}

double load_average() {
  std::array<double, 1> load{};
  return ::getloadavg(load.data(), 1) == 1 ? load[0] : -1;
}

std::vector<Corners> triangles_of(const Scene& scene) {
  std::vector<Corners> triangles;
  for (const Object& object : scene.objects)
    for (const auto& t : object.mesh.triangles)
      triangles.push_back(
          {object.mesh.positions[t[0]], object.mesh.positions[t[1]], object.mesh.positions[t[2]]});
  return triangles;
}

/// As pixel_ray of kernels/first_hit.cl; pixels in blocks of 4x4, so that packets hold neighbours.
RayWords pixel_ray(const kernels::ViewData& view, std::size_t i) {
  const std::size_t blocks = view.width / 4, block = i / 16, in = i % 16;
  const auto x = static_cast<float>(block % blocks * 4 + in % 4);
  const auto y = static_cast<float>(block / blocks * 4 + in / 4);
  const float sx = 2 * (x + 0.5f) / static_cast<float>(view.width) - 1;
  const float sy = 1 - 2 * (y + 0.5f) / static_cast<float>(view.height);
  RayWords ray;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray[axis] = view.start[axis] + sx * view.start_right[axis] + sy * view.start_up[axis];
    ray[3 + axis] = view.forward[axis] + sx * view.right[axis] + sy * view.up[axis];
  }
  ray[6] = 1e30f;
  return ray;
}

std::size_t pixel_of(const kernels::ViewData& view, std::size_t i) {
  const std::size_t blocks = view.width / 4, block = i / 16, in = i % 16;
  return (block / blocks * 4 + in / 4) * view.width + block % blocks * 4 + in % 4;
}

void run(int count, char** arguments) {
  if (count < 4) fail(ErrorKind::usage, "wanted MODEL MATERIAL ENVIRONMENT [SIZE [REPEATS]]");
  const int size = (count > 4 ? std::stoi(arguments[4]) : 1024) / 4 * 4;
  const int repeats = count > 5 ? std::stoi(arguments[5]) : 9;
  Scene scene = compose(read_environment(arguments[3]), read_material(arguments[2]),
                        normalise(read_model(arguments[1]).mesh, {}));
  load_images(scene);
  Camera camera;
  camera.position = normalized(Vec3d{1, 1, 1}) * 0.252;
  EngineSettings engine;
  engine.width = engine.height = size;
  const kernels::ViewData view = view_data(camera, engine);
  const std::vector<Corners> triangles = triangles_of(scene);
  const EmbreeTracer embree(triangles);
  Tracer tracer({});
  tracer.set_scene(scene);

  const std::size_t pixels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  std::vector<float> depth(pixels);
  std::vector<std::uint8_t> mask(pixels);
  const auto make = [&](std::size_t i) { return pixel_ray(view, i); };
  const auto take = [&](std::size_t i, const Met& met) {
    depth[pixel_of(view, i)] = met.any ? met.t : 0.0f;
    mask[pixel_of(view, i)] = met.any ? 255 : 0;
  };
  std::vector<Plane> planes;
  const auto trace = [&](const std::vector<const PlaneType*>& types) {
    return [&, types] { planes = tracer.trace_planes(camera, size, size, types); };
  };
  std::vector<const PlaneType*> many;
  for (const PlaneType& type : plane_types())
    if (!is_of_light(type) && !reads_materials(type) && type.name != "amodal_mask")
      many.push_back(&type);
  std::vector<Contender> contenders = {
      {"rtcIntersect1", [&] { embree.trace_each(pixels, make, take); }, {}},
      {"rtcIntersect16, 4x4 pixels", [&] { embree.trace_packets(pixels, make, take); }, {}},
      {"dsbuild: mask, depth", trace({&plane_type("mask"), &plane_type("depth")}), {}},
      {fmt::format("dsbuild: {} planes", many.size()), trace(many), {}},
      {"dsbuild: albedo", trace({&plane_type("albedo")}), {}}};
  for (Contender& one : contenders)
    one.run();  // programs, trees
  contenders[2].run();
  contenders[0].run();
  std::size_t agreed = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    agreed += std::fabs(planes[1].values[i] - depth[i]) <= 1e-4f * depth[i] ? 1U : 0U;

  const double load = load_average();
  for (int turn = 0; turn < repeats; ++turn)
    for (Contender& one : contenders)
      measure(one, static_cast<double>(pixels));
  fmt::print(
      "{}, {} threads, {} triangles, {}x{}, {} turns, load average {:.1f} before, {:.1f} after\n",
      tracer.device_name(), EmbreeTracer::threads(), triangles.size(), size, size, repeats, load,
      load_average());
  fmt::print("same depth: {:.4f} % of the pixels\n\n",
             100 * static_cast<double>(agreed) / static_cast<double>(pixels));
  fmt::print("{:<28} {:<26} {:<26} {:<26} {}\n", "million pixels a second", "by the clock",
             "over rtcIntersect1", "by processor time", "over rtcIntersect1");
  const Rates& base = contenders.front().rates;
  for (const Contender& one : contenders)
    fmt::print("{:<28} {:<26} {:<26} {:<26} {}\n", one.name, spread(one.rates.wall),
               ratio(one.rates.wall, base.wall), spread(one.rates.processor),
               ratio(one.rates.processor, base.processor));
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    ds::run(count, arguments);
    return 0;
  } catch (const ds::Error& error) {
    fmt::print(stderr, "planes_bench: {}\n", error.what());
    return ds::exit_code(error.kind());
  }
}

// SPDX-License-Identifier: Apache-2.0
// What leaving out the effects that a scene does not call for is worth, and what it costs to
// compile (tests/bench/bench.py runs it):
//
//   effects_bench ASSETS MODEL SIZE SPP REPEATS
//
// Every distinct program is compiled from its source. Then for every shipped environment with every
// shipped material the specialised and the full program take turns on a picture of SIZE x SIZE
// pixels. Answers
//   {"pairs": [{"environment", "material", "specialised": times, "full": times, "equal": bool}],
//    "compile": [{"pairs": [names], times}], the last the full program, "compiler_start": times}
// where times are {"seconds": [s], "cpu_seconds": [s, of all threads]}.
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/device/opencl.h"
#include "tracer/device/program_text.h"
#include "tracer/render/path_programs.h"
#include "tracer/render/render.h"
#include "tracer/scene/sdl.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Pair {
  std::string environment, material;
  Scene scene;

  std::string name() const { return environment + " " + material; }
};

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<Pair> shipped_pairs(const fs::path& assets, const fs::path& model) {
  NormaliseOptions options;
  options.up = UpAxis::y;
  const Mesh mesh = normalise(read_model(model).mesh, options);
  std::vector<Pair> pairs;
  for (const fs::path& environment : entries(assets / "environments"))
    for (const fs::path& material : entries(assets / "materials"))
      if (material.extension() == ".mat")
        pairs.push_back({environment.filename(), material.stem(),
                         compose(read_environment(environment), read_material(material), mesh)});
  return pairs;
}

/// With a lens, as the shipped recipe has it.
Camera bench_camera() {
  Camera camera;
  camera.position = normalized(Vec3d{1, 1, 1}) * 0.252;
  camera.lens_radius_m = 0.002;
  return camera;
}

class Stopwatch {
 public:
  /// Appends what has passed since it was made.
  void append(json& times) const {
    times["cpu_seconds"].push_back(static_cast<double>(std::clock() - cpu_begin_) / CLOCKS_PER_SEC);
    times["seconds"].push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::clock_t cpu_begin_ = std::clock();
};

/// Times one picture and appends to `times`.
std::vector<float> trace(Tracer& tracer, const EngineSettings& engine, json& times) {
  const Stopwatch watch;
  Film film = tracer.trace(bench_camera(), engine);
  watch.append(times);
  return std::move(film.rgb);
}

json measure_pair(const Pair& pair, Tracer& specialised, Tracer& full, EngineSettings engine,
                  int repeats) {
  json result{{"environment", pair.environment}, {"material", pair.material}, {"equal", true}};
  specialised.set_scene(pair.scene);
  full.set_scene(pair.scene);
  json warm_up;
  trace(specialised, engine, warm_up);
  trace(full, engine, warm_up);
  for (int i = 0; i < repeats; ++i) {
    engine.seed = static_cast<std::uint64_t>(i);
    const std::vector<float> one = trace(specialised, engine, result["specialised"]);
    if (trace(full, engine, result["full"]) != one) result["equal"] = false;
  }
  return result;
}

/// Before anything else is compiled: `compiler_start` is what an empty program takes as the first
/// one of a process, in which PoCL reads its library of built-in functions.
void measure_compiling(const std::vector<Pair>& pairs, int repeats, json& result) {
  std::map<std::string, std::vector<std::string>> programs;  // names of pairs by program text
  for (const Pair& pair : pairs)
    programs[path_program_text(scene_effects(pair.scene, bench_camera()))].push_back(pair.name());
  const Device device("");
  const std::string options =
      fmt::format("{} -DDS_LANES={}", k_strict_options, default_lanes(device.info()));
  const auto compile = [&](const std::string& text, json& times) {
    const TemporaryFolder cache;
    const Stopwatch watch;
    device.kernel(device.build(text, options, cache.path()), "trace_paths");
    watch.append(times);
  };
  compile("__kernel void trace_paths(__global float* a) { a[0] = 1; }", result["compiler_start"]);
  const auto measure_program = [&](const std::string& text, const std::vector<std::string>& names) {
    json program{{"pairs", names}};
    for (int i = 0; i < repeats; ++i)
      compile(text, program);
    result["compile"].push_back(std::move(program));
  };
  for (const auto& [text, names] : programs)
    measure_program(text, names);
  measure_program(path_program_text(all_effects()), {"full program"});
}

int whole_number(const char* text) {
  const int value = std::atoi(text);
  if (value < 1) fail(ErrorKind::usage, "wanted a number, found {}", text);
  return value;
}

void measure(int count, char** arguments) {
  if (count != 6) fail(ErrorKind::usage, "wanted ASSETS MODEL SIZE SPP REPEATS");
  const std::vector<Pair> pairs = shipped_pairs(arguments[1], arguments[2]);
  EngineSettings engine;
  engine.width = engine.height = whole_number(arguments[3]);
  engine.spp = whole_number(arguments[4]);
  json result{{"pairs", json::array()}};
  measure_compiling(pairs, whole_number(arguments[5]), result);
  TracerOptions options;
  Tracer specialised(options);
  options.full_program = true;
  Tracer full(options);
  for (const Pair& pair : pairs)
    result["pairs"].push_back(
        measure_pair(pair, specialised, full, engine, whole_number(arguments[5])));
  fmt::print("{}\n", result.dump());
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    ds::measure(count, arguments);
    return 0;
  } catch (const ds::Error& error) {
    fmt::print(stderr, "effects_bench: {}\n", error.what());
    return ds::exit_code(error.kind());
  }
}

// SPDX-License-Identifier: Apache-2.0
// dsbuild's side of the render benchmark (tests/bench/bench.py runs it, and the peers by the same
// protocol):
//
//   render_bench MODEL MATERIAL ENVIRONMENT FOLDER [FILTER_WIDTH]
//
// composes the scene, writes it to FOLDER for the peers (export_scene.h), prepares the device and
// answers
//   {"name": text, "triangles": n}
// Then each line "WIDTH HEIGHT SPP SEED FILE" on standard input traces one picture, writes its
// linear film to FILE (float32 r g b, row 0 at the top) and FILE.exr, and answers
//   {"seconds": of tracing alone, "cpu_seconds": of all threads, "samples": traced, "rejected": of
//   these}
// A lens is left out: the peers' depth of field is not what is compared.
#include "tests/bench/export_scene.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/render/develop.h"
#include "tracer/render/images.h"
#include "tracer/render/render.h"
#include "tracer/scene/sdl.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <span>
#include <sstream>
#include <string>

namespace ds {
namespace {

using nlohmann::json;

void answer(const json& object) {
  fmt::print("{}\n", object.dump());
  std::fflush(stdout);
}

/// One of the thesis's views, 0.252 m away and from above.
Camera bench_camera() {
  Camera camera;
  camera.position = normalized(Vec3d{1, 1, 1}) * 0.252;
  return camera;
}

Scene bench_scene(char** arguments) {
  const Scene environment = read_environment(arguments[3]);
  const Scene material = read_material(arguments[2]);
  Scene scene = compose(environment, material, normalise(read_model(arguments[1]).mesh, {}));
  load_images(scene);
  return scene;
}

void trace_one(Tracer& tracer, const Camera& camera, EngineSettings engine,
               const std::string& request) {
  std::istringstream words(request);
  std::string file;
  if (!(words >> engine.width >> engine.height >> engine.spp >> engine.seed >> file))
    fail(ErrorKind::usage, "wanted WIDTH HEIGHT SPP SEED FILE, found \"{}\"", request);
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu_begin = std::clock();
  const Film film = tracer.trace(camera, engine);
  const double cpu_seconds = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  write_file_atomic(file, std::as_bytes(std::span(film.rgb)));
  write_file_atomic(file + ".exr", encode_film_exr(film));
  answer({{"seconds", seconds.count()},
          {"cpu_seconds", cpu_seconds},
          {"samples", double(engine.width) * engine.height * engine.spp},
          {"rejected", film.rejected_samples}});
}

void serve(int count, char** arguments) {
  if (count != 5 && count != 6)
    fail(ErrorKind::usage, "wanted MODEL MATERIAL ENVIRONMENT FOLDER [FILTER_WIDTH]");
  const Scene scene = bench_scene(arguments);
  const Camera camera = bench_camera();
  EngineSettings engine;
  if (count == 6) engine.filter_width = std::stof(arguments[5]);
  export_scene(scene, camera, engine, arguments[4]);

  Tracer tracer({});
  tracer.set_scene(scene);
  // The first picture packs the scene and compiles its program.
  EngineSettings small = engine;
  small.width = small.height = 64;
  small.spp = 1;
  tracer.trace(camera, small);
  std::size_t triangles = 0;
  for (const Object& object : scene.objects)
    triangles += object.mesh.triangles.size();
  answer({{"name", "dsbuild on " + tracer.device_name()}, {"triangles", triangles}});
  for (std::string line; std::getline(std::cin, line);)
    trace_one(tracer, camera, engine, line);
}

}  // namespace
}  // namespace ds

int main(int count, char** arguments) {
  try {
    ds::serve(count, arguments);
    return 0;
  } catch (const ds::Error& error) {
    fmt::print(stderr, "render_bench: {}\n", error.what());
    return ds::exit_code(error.kind());
  }
}

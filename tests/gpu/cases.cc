// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/cases.h"

#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace ds::gpu {
namespace {

using namespace pictures;

EngineSettings tiny_engine() {
  EngineSettings engine;
  engine.width = 24;
  engine.height = 16;
  engine.spp = 4;
  engine.seed = 0x123456789abcdef0u;
  return engine;
}

Camera tiny_camera() {
  Camera camera;
  camera.position = {0.2f, -1.3f, 0.8f};
  camera.focus_distance_m = 1.3;
  return camera;
}

/// A floor; the first two materials are what a mix takes.
Scene floor_scene() {
  Scene scene;
  const int grey = add_matte(scene, {0.6f, 0.55f, 0.5f});
  add_matte(scene, {0.1f, 0.2f, 0.6f});
  add_object(scene, quad({0, 0, -0.35f}, {2, 0, 0}, {0, 2, 0}), grey);
  return scene;
}

Picture of_scene(std::string name, Scene scene) {
  return {std::move(name), std::move(scene), tiny_camera(), tiny_engine()};
}

/// The model shows it beside a small light, so that what casts caustics is guided to.
Picture of_material(const NodeType& type) {
  Scene scene = floor_scene();
  const int material = add_material(scene, type.name);
  make_seen(scene, material);
  add_object(scene, sphere({0, 0, 0}, 0.34f, 9, true), material, k_model_object_id);
  scene.lights.push_back(point_light({-1, -1, 2}, {3, 2.5f, 2}));
  scene.lights.push_back(constant_light({0.2f, 0.25f, 0.3f}));
  return of_scene(fmt::format("material-{}", type.kernel_prefix), scene);
}

Picture of_texture(const NodeType& type) {
  Scene scene = floor_scene();
  scene.images.push_back(small_sky());
  const int texture = add_texture(scene, type.name, {{0.8f, 0.6f, 0.4f}, -1});
  const int material = add_material(scene, "matte");
  scene.materials.back().inputs[0] = {{}, texture};
  Mesh panel = quad({0, 0.1f, 0.1f}, {0.5f, 0, 0.1f}, {0, 0.2f, 0.4f});
  panel.colors = {{0.9f, 0.1f, 0.1f, 0.2f},
                  {0.1f, 0.8f, 0.1f, 0.4f},
                  {0.1f, 0.1f, 0.7f, 0.6f},
                  {0.6f, 0.6f, 0, 0.8f}};
  add_object(scene, panel, material, k_model_object_id);
  scene.lights.push_back(point_light({-1, -1, 2}, {3, 2.5f, 2}));
  return of_scene(fmt::format("texture-{}", type.kernel_prefix), scene);
}

Picture of_light(const LightType& type) {
  Scene scene = floor_scene();
  add_object(scene, box({0, 0, 0}, {0.2f, 0.25f, 0.3f}), 1, k_model_object_id);
  add_light(scene, type.kernel_prefix);
  return of_scene(fmt::format("light-{}", type.kernel_prefix), scene);
}

/// A teapot in red plastic. A picture of 4 million samples takes a tenth of a second where 40
/// million are traced a second, and fills a GPU.
Picture of_environment(const std::filesystem::path& assets, const char* name) {
  NormaliseOptions options;
  options.up = UpAxis::y;
  Scene scene = compose(read_environment(assets / "environments" / name),
                        read_material(assets / "materials/red-plastic.mat"),
                        normalise(read_model(assets / "models/teapot-1.ply").mesh, options));
  Camera camera;
  camera.position = normalized(Vec3d{1, 1, 1}) * 0.252;
  EngineSettings engine;
  engine.spp = 16;
  return {name, std::move(scene), camera, engine};
}

/// The picture of everything in the ways that change no bit (tests/render/same_bits_test.cc).
std::vector<Case> other_ways() {
  const std::pair<const char*, void (*)(TracerOptions&)> ways[] = {
      {"way-groups-of-256", [](TracerOptions& o) { o.work_group_size = 256; }},
      {"way-5-pixels-an-item", [](TracerOptions& o) { o.item_pixels = 5; }},
      {"way-bvh-of-width-2", [](TracerOptions& o) { o.bvh_width = 2; }},
      {"way-full-program", [](TracerOptions& o) { o.full_program = true; }},
      {"way-4-lanes", [](TracerOptions& o) { o.lanes = o.item_pixels = 4; }}};
  std::vector<Case> cases;
  for (const auto& [name, change] : ways) {
    cases.push_back({all_effects().back()});
    cases.back().picture.name = name;
    cases.back().change = change;
  }
  return cases;
}

}  // namespace

std::vector<Case> all_cases(const std::filesystem::path& assets) {
  std::vector<Case> cases;
  for (const NodeType& type : material_types())
    cases.push_back({of_material(type)});
  for (const NodeType& type : texture_types())
    cases.push_back({of_texture(type)});
  for (const LightType& type : light_types())
    cases.push_back({of_light(type)});
  for (const Picture& picture : all_effects()) {
    cases.push_back({picture});
    cases.back().picture.name = "all-" + picture.name;
  }
  cases.push_back({all_effects().back(), Traces::planes});
  cases.back().picture.name = "all-planes";
  cases.push_back({all_effects().back(), Traces::light});
  cases.back().picture.name = "all-light";
  cases.push_back({all_effects().back()});
  cases.back().picture.name = "all-scheduled";
  cases.back().picture.engine.target = ErrorTarget{0.02, 48, cases.back().picture.scene.tone_map};
  for (const char* name : {"office", "outdoor", "studio"})
    cases.push_back({of_environment(assets, name), Traces::picture, true});
  const std::size_t environments_end = cases.size();
  for (std::size_t i = environments_end - 3; i < environments_end; ++i) {
    Case geometry = cases[i];
    geometry.picture.name += "-geometry";
    geometry.picture.engine.width = geometry.picture.engine.height = 1024;
    geometry.traces = Traces::geometry;
    cases.push_back(std::move(geometry));
  }
  // Behind the other pictures: a GPU takes half a minute to compile the program of four lanes.
  for (Case& way : other_ways())
    cases.push_back(std::move(way));
  return cases;
}

}  // namespace ds::gpu

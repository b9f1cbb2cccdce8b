// SPDX-License-Identifier: Apache-2.0
#include "tests/hard/everywhere.h"

#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>

namespace ds::hard {

std::string Way::name() const {
  return fmt::format("{}, N = {}, {} program", math == MathMode::strict ? "strict" : "fast", lanes,
                     full_program ? "full" : "specialised");
}

std::vector<Way> ways() {
  const bool all = std::getenv("DSBUILD_TEST_WAYS") != nullptr;
  std::vector<Way> ways;
  for (const bool fast : {false, true})
    for (const bool single : {false, true})
      for (const bool full : {false, true})
        if (all || (fast != single) == full)
          ways.push_back({fast ? MathMode::fast : MathMode::strict, single ? 1 : 16, full});
  return ways;
}

std::vector<Way> full_program_ways() {
  std::vector<Way> full = ways();
  std::erase_if(full, [](const Way& way) { return !way.full_program; });
  return full;
}

namespace {

Tracer& tracer_of(const Way& way) {
  static std::map<std::string, std::unique_ptr<Tracer>> tracers;
  std::unique_ptr<Tracer>& tracer = tracers[way.name()];
  if (!tracer) {
    TracerOptions options = pictures::tracer_options();
    options.lanes = way.lanes;
    options.full_program = way.full_program;
    tracer = std::make_unique<Tracer>(options);
  }
  return *tracer;
}

}  // namespace

Film trace(const pictures::Picture& picture, const Way& way) {
  Tracer& tracer = tracer_of(way);
  tracer.set_scene(picture.scene);
  EngineSettings engine = picture.engine;
  engine.math = way.math;
  return tracer.trace(picture.camera, engine);
}

void everywhere(const pictures::Picture& picture, const std::function<void(const Film&)>& check) {
  std::string strict_hash;
  for (const Way& way : ways()) {
    SCOPED_TRACE(picture.name + ": " + way.name());
    const Film film = trace(picture, way);
    EXPECT_EQ(film.rejected_samples, 0u);
    EXPECT_TRUE(std::all_of(film.rgb.begin(), film.rgb.end(),
                            [](float v) { return v >= 0 && std::isfinite(v); }));
    if (way.math == MathMode::strict) {
      const std::string hash = pictures::film_hash(film);
      if (strict_hash.empty()) strict_hash = hash;
      EXPECT_EQ(hash, strict_hash);
    }
    check(film);
  }
}

pictures::Estimate estimate(const pictures::Picture& picture, const Way& way, int pictures,
                            std::uint64_t first_seed) {
  Tracer& tracer = tracer_of(way);
  tracer.set_scene(picture.scene);
  EngineSettings engine = picture.engine;
  engine.math = way.math;
  std::vector<double> means;
  for (int i = 0; i < pictures; ++i) {
    engine.seed = pictures::wide_seed(first_seed + static_cast<std::uint64_t>(i));
    means.push_back(mean_of(tracer.trace(picture.camera, engine)));
  }
  pictures::Estimate e;
  for (const double m : means)
    e.mean += m / pictures;
  double squares = 0;
  for (const double m : means)
    squares += (m - e.mean) * (m - e.mean);
  e.error = std::sqrt(squares / (pictures - 1) / pictures);
  return e;
}

std::vector<std::string> materials(bool with_transparent) {
  std::vector<std::string> names;
  for (const NodeType& type : material_types())
    if (with_transparent || find_input(type, "kt") < 0) names.emplace_back(type.name);
  return names;
}

int add_mix(Scene& scene, int first, int second) {
  const int mix = pictures::add_material(scene, "mix");
  Material& material = scene.materials[static_cast<std::size_t>(mix)];
  material.children[0] = first;
  material.children[1] = second;
  return mix;
}

void set_alpha(Scene& scene, int material, float alpha) {
  const int row = scene.materials[static_cast<std::size_t>(material)].type;
  const float root = std::sqrt(alpha);
  for (const auto& [input, value] :
       {std::pair{"uroughness", alpha}, {"vroughness", alpha}, {"roughness", root}})
    if (find_input(material_types()[static_cast<std::size_t>(row)], input) >= 0)
      pictures::set_input(scene, material, input, {value, value, value});
}

int add_material(Scene& scene, std::string_view type) {
  if (type != "mix") {
    const int material = pictures::add_material(scene, type);
    pictures::make_seen(scene, material);
    set_alpha(scene, material, 0.1f);  // the default of those that have one
    return material;
  }
  const int metal = pictures::add_material(scene, "metal2");
  const int matte = pictures::add_material(scene, "matte");
  const int mirror = pictures::add_material(scene, "mirror");
  return add_mix(scene, metal, add_mix(scene, matte, mirror));
}

void add_patches(Scene& scene, const Mesh& mesh, const std::vector<int>& materials) {
  for (std::size_t first = 0; first < materials.size(); ++first) {
    Mesh patch = mesh;
    patch.triangles.clear();
    for (std::size_t i = first; i < mesh.triangles.size(); i += materials.size())
      patch.triangles.push_back(mesh.triangles[i]);
    pictures::add_object(scene, patch, materials[first]);
  }
}

std::vector<int> add_white_materials(Scene& scene, float u_roughness, float v_roughness) {
  std::vector<int> added;
  const std::size_t before = scene.materials.size();
  for (const std::string& name : materials(false)) {
    // A layer of fibres over black gives back a part of the light whatever its colour, and so do
    // disney's parts together.
    if (name != "velvet" && name != "disney") added.push_back(add_material(scene, name));
  }
  for (std::size_t i = before; i < scene.materials.size(); ++i) {
    const NodeType& type = material_types()[static_cast<std::size_t>(scene.materials[i].type)];
    // n = 0 makes a metal's reflectance 1.
    for (const auto& [input, value] : {std::pair{"kd", 1.0f},
                                       {"ks", 1.0f},
                                       {"kr", 1.0f},
                                       {"n", 0.0f},
                                       {"uroughness", u_roughness},
                                       {"vroughness", v_roughness}})
      if (find_input(type, input) >= 0)
        pictures::set_input(scene, static_cast<int>(i), input, {value, value, value});
  }
  return added;
}

pictures::Picture deep_picture(int pixels, int spp, int roulette) {
  pictures::Picture p;
  p.engine.width = p.engine.height = pixels;
  p.engine.spp = spp;
  p.engine.seed = 0x5eed5eed12345678u;
  p.engine.depth_total = p.engine.depth_diffuse = p.engine.depth_glossy = p.engine.depth_specular =
      1000;
  p.engine.roulette_depth = roulette;
  p.engine.filter_width = 0;
  return p;
}

double worst_difference(const Film& film, double expected) {
  double worst = 0;
  for (const float v : film.rgb)
    worst = std::max(worst, std::isfinite(v) ? std::fabs(double{v} - expected) : 1e300);
  return worst;
}

double mean_of(const Film& film) {
  double sum = 0;
  for (const float v : film.rgb)
    sum += double{v};
  return sum / static_cast<double>(film.rgb.size());
}

}  // namespace ds::hard

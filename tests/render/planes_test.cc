// SPDX-License-Identifier: Apache-2.0
// Planes that ask no light (those of light: light_planes_test.cc), against rays cast in double precision, and what they have to do with
// each other.
#include "tests/render/pictures.h"
#include "tests/render/ray_caster.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>

namespace ds {
namespace {

using ray_caster::Hit;

constexpr int k_width = 40, k_height = 30;

std::vector<const PlaneType*> all_types() {
  std::vector<const PlaneType*> types;
  for (const PlaneType& type : plane_types())
    if (!is_of_light(type)) types.push_back(&type);
  return types;
}

/// A smooth model behind a box, on a floor, seen through a pane that the camera does not see.
Scene still_life() {
  Scene scene;
  const int floor = pictures::add_matte(scene, {0.5f, 0.5f, 0.5f});
  const int red = pictures::add_matte(scene, {0.8f, 0.1f, 0.1f});
  scene.materials[static_cast<std::size_t>(red)].id = 70000;
  pictures::add_object(scene, pictures::quad({0, 0, -0.5f}, {3, 0, 0}, {0, 2, 0}), floor, 0);
  pictures::add_object(scene, pictures::box({0.35f, -0.6f, -0.2f}, {0.2f, 0.15f, 0.3f}), floor,
                       3000000000u);
  pictures::add_object(scene, pictures::quad({0, -1.2f, 0}, {2, 0, 0}, {0, 0.1f, 2}), red, 5);
  scene.objects.back().camera_invisible = true;
  pictures::add_object(scene, pictures::sphere({}, 0.45f, 12, true), red, k_model_object_id);
  // Face by face in one of two, as a model's own materials are.
  const int blue = pictures::add_matte(scene, {0.1f, 0.2f, 0.7f});
  scene.materials[static_cast<std::size_t>(blue)].id = 2;
  Object& model = scene.objects.back();
  for (std::size_t i = 0; i < model.mesh.triangles.size(); ++i)
    model.triangle_materials.push_back(static_cast<std::uint32_t>(i % 3 == 0 ? blue : red));
  return scene;
}

Camera from_the_front() {
  Camera camera;
  camera.position = {0.3, -2.5, 0.9};
  camera.target = {0.05, 0, -0.1};
  camera.fov_deg = 50;
  return camera;
}

std::map<std::string, Plane> trace(const Scene& scene, const Camera& camera,
                                   const std::vector<const PlaneType*>& types, int lanes = 0,
                                   int height = k_height) {
  TracerOptions options = pictures::tracer_options();
  options.lanes = lanes;
  Tracer tracer(options);
  tracer.set_scene(scene);
  std::map<std::string, Plane> planes;
  for (Plane& plane : tracer.trace_planes(camera, k_width, height, types))
    planes.emplace(plane.type->name, std::move(plane));
  return planes;
}

/// What a plane is to hold of a hit; objects and materials by their index.
std::vector<double> right_numbers(std::string_view name, const Scene& scene, const Hit& hit) {
  const auto three = [](Vec3d v) { return std::vector<double>{v.x, v.y, v.z}; };
  const Object& object = scene.objects[static_cast<std::size_t>(hit.object)];
  const Material& material = scene.materials[static_cast<std::size_t>(
      material_of_triangle(object, static_cast<std::size_t>(hit.triangle)))];
  if (name == "mask" || name == "amodal_mask") return {object.id == k_model_object_id ? 1.0 : 0.0};
  if (name == "depth") return {hit.depth};
  if (name == "distance") return {hit.distance};
  if (name == "position") return three(hit.position);
  if (name == "geometry_normal") return three(hit.normal);
  // Where it would face away, as at silhouettes, it is lifted until it does not (surface.h).
  if (name == "shading_normal")
    return three(normalized(hit.shading +
                            hit.towards * std::max(0.0, 0.01 - dot(hit.shading, hit.towards))));
  if (name == "uv") return {hit.u, hit.v};
  // Of a matte.
  if (name == "albedo") return three(to_double(material.inputs[0].constant));
  if (name == "object_id") return {static_cast<double>(object.id)};
  if (name == "material_id") return {static_cast<double>(material.id)};
  ADD_FAILURE() << "no right value for the plane " << name;
  return {};
}

void expect_what_rays_in_double_meet(const Camera& camera) {
  const Scene scene = still_life();
  const std::vector<Hit> hits = ray_caster::cast(scene, camera, k_width, k_height);
  const std::vector<Hit> of_model = ray_caster::cast_model(scene, camera, k_width, k_height);
  int seen = 0, hidden = 0;
  for (const auto& [name, plane] : trace(scene, camera, all_types())) {
    const bool alone = (plane.type->traits & kernels::k_plane_alone) != 0;
    const bool words = (plane.type->traits & kernels::k_plane_words) != 0;
    const auto width = static_cast<std::size_t>(plane.type->width);
    ASSERT_EQ(plane.values.size(), hits.size() * width) << name;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Hit& hit = (alone ? of_model : hits)[i];
      // Next to an edge another triangle may be met.
      if (hit.object >= 0 && hit.margin < 1e-4) continue;
      const std::vector<double> right =
          hit.object >= 0 ? right_numbers(name, scene, hit) : std::vector<double>(width);
      ASSERT_EQ(right.size(), width) << name;
      for (std::size_t k = 0; k < width; ++k) {
        const float value = plane.values[i * width + k];
        const double number =
            words ? static_cast<double>(std::bit_cast<std::uint32_t>(value)) : double{value};
        EXPECT_NEAR(number, right[k], 1e-5 * (1 + std::fabs(right[k])))
            << name << ", pixel " << i % k_width << ", " << i / k_width;
      }
    }
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    seen += hits[i].object == 3 ? 1 : 0;
    hidden += of_model[i].object == 3 && hits[i].object == 1 ? 1 : 0;
  }
  EXPECT_GT(seen, 50);
  EXPECT_GT(hidden, 10);
}

/// Of each object, as if it were alone, and whichever of them is the model.
TEST(Planes, AloneMasksHoldWhatRaysInDoubleMeet) {
  Scene scene = still_life();
  scene.objects[0].id = 7;
  const Camera camera = from_the_front();
  Tracer tracer(pictures::tracer_options());
  tracer.set_scene(scene);
  const std::vector<std::uint32_t> ids{3000000000u, k_model_object_id, 7, 4711};
  const std::vector<Plane> masks = tracer.trace_alone(camera, k_width, k_height, ids);
  ASSERT_EQ(masks.size(), ids.size());
  for (std::size_t which = 0; which < ids.size(); ++which) {
    Scene alone = scene;
    std::erase_if(alone.objects, [&](const Object& object) { return object.id != ids[which]; });
    std::vector<Hit> hits(masks[which].values.size());
    if (!alone.objects.empty()) hits = ray_caster::cast(alone, camera, k_width, k_height);
    int covered = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      covered += hits[i].object >= 0 ? 1 : 0;
      if (hits[i].object >= 0 && hits[i].margin < 1e-4) continue;
      EXPECT_EQ(masks[which].values[i] > 0, hits[i].object >= 0) << ids[which] << ", pixel " << i;
    }
    EXPECT_EQ(covered > 20, ids[which] != 4711) << covered;
  }
}

TEST(Planes, HoldWhatRaysInDoubleMeet) {
  for (std::size_t type = 0; type < camera_types().size(); ++type) {
    SCOPED_TRACE(camera_types()[type].name);
    Camera camera = from_the_front();
    camera.type = static_cast<int>(type);
    camera.extent_m = 2.2;
    expect_what_rays_in_double_meet(camera);
  }
}

TEST(Planes, AreTheSameBitsAloneInAnyOrderAndAnyLanes) {
  constexpr int k_odd = 29;  // the last lanes have no pixel
  const Scene scene = still_life();
  const Camera camera = from_the_front();
  std::vector<const PlaneType*> types = all_types();
  const std::map<std::string, Plane> together = trace(scene, camera, types, 0, k_odd);
  std::reverse(types.begin(), types.end());
  const std::map<std::string, Plane> reversed = trace(scene, camera, types, 0, k_odd);
  const auto bits = [](const Plane& plane) {
    std::vector<std::uint32_t> words;
    for (const float value : plane.values)
      words.push_back(std::bit_cast<std::uint32_t>(value));
    return words;
  };
  for (const int lanes : {1, 4, 16})
    for (const auto& [name, plane] : trace(scene, camera, types, lanes, k_odd))
      EXPECT_EQ(bits(plane), bits(together.at(name))) << name << ", " << lanes << " lanes";
  for (const PlaneType* type : types) {
    const std::string name(type->name);
    EXPECT_EQ(bits(reversed.at(name)), bits(together.at(name))) << name;
    EXPECT_EQ(bits(trace(scene, camera, {type}, 0, k_odd).at(name)), bits(together.at(name)))
        << name;
  }
}

std::vector<std::uint32_t> depth_bits(const Scene& scene, const Camera& camera, int lanes) {
  const std::map<std::string, Plane> planes =
      trace(scene, camera, {&plane_type("depth"), &plane_type("object_id")}, lanes);
  std::vector<std::uint32_t> words;
  for (const float value : planes.at("depth").values)
    words.push_back(std::bit_cast<std::uint32_t>(value));
  return words;
}

TEST(Planes, OfTilesWhoseRaysPartAreThoseOfSingleRays) {
  const Scene scene = still_life();
  Camera camera;
  camera.position = {0.05, -2.5, -0.1};  // along y: x and z change their signs within tiles
  camera.target = {0.05, 0, -0.1};
  camera.fov_deg = 120;  // and the longest axis does
  const std::vector<std::uint32_t> single = depth_bits(scene, camera, 1);
  for (const int lanes : {4, 8, 16})
    EXPECT_EQ(depth_bits(scene, camera, lanes), single) << lanes;
}

TEST(Planes, FromAHairOverAFloorAreThoseOfSingleRays) {
  // There a triangle's test asks for the distance to its plane (bvh.cl), which packets leave to
  // single rays.
  const Scene scene = still_life();
  Camera camera;
  camera.position = {0.9, -1, -0.5 + 2e-7};
  camera.target = {0.9, 1, -0.9};
  const std::vector<std::uint32_t> single = depth_bits(scene, camera, 1);
  const auto near = std::count_if(single.begin(), single.end(), [](std::uint32_t bits) {
    const float depth = std::bit_cast<float>(bits);
    return depth > 0 && depth < 5e-7f;
  });
  EXPECT_GT(near, 100);
  for (const int lanes : {4, 8, 16})
    EXPECT_EQ(depth_bits(scene, camera, lanes), single) << lanes;
}

TEST(Planes, AProgramHoldsThoseItIsAskedFor) {
  for (const PlaneType* asked : all_types()) {
    const std::vector<const PlaneType*> one{asked};
    const std::string text = program_tokens(planes_program_text(one));
    for (const PlaneType* other : all_types())
      EXPECT_EQ(text.find(" " + std::string(other->name) + "_at(") != text.npos, asked == other)
          << asked->name << " and " << other->name;
  }
}

TEST(Planes, OfASceneWithoutTheModelAreEmpty) {
  Scene scene = still_life();
  scene.objects.pop_back();
  for (const auto& [name, plane] : trace(scene, from_the_front(), all_types())) {
    const bool of_model = name == "mask" || name == "amodal_mask";
    EXPECT_EQ(std::any_of(plane.values.begin(), plane.values.end(),
                          [](float v) { return std::bit_cast<std::uint32_t>(v) != 0; }),
              !of_model && name != "material_id")
        << name;
  }
}

}  // namespace
}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/vary.h"

#include "tracer/base/degrees.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/colour_temperature.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>

namespace ds {
namespace {

using kernels::LightInput;
using kernels::LightValue;

Mat4 turn_about_z(double degrees) {
  const double c = cos_deg(degrees), s = sin_deg(degrees);
  Mat4 turn;
  turn.m = {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return turn;
}

void turn(Light& light, const Mat4& by) {
  for (const LightInput& input : type_of(light).host.inputs) {
    if (input.value != LightValue::point && input.value != LightValue::direction) continue;
    const Vec3d value = to_double(light_vector(light, input.name));
    set_light_value(light, input.name, to_float(by.direction(value)));
  }
  light.light_to_world = by * light.light_to_world;
}

void turn(Mesh& mesh, const Mat4& by) {
  const auto turned = [&](Vec3& v) { v = to_float(by.direction(to_double(v))); };
  std::for_each(mesh.positions.begin(), mesh.positions.end(), turned);
  std::for_each(mesh.normals.begin(), mesh.normals.end(), turned);
}

void turn(Scene& scene, double degrees) {
  const Mat4 forth = turn_about_z(degrees), back = turn_about_z(-degrees);
  for (Object& object : scene.objects)
    turn(object.mesh, forth);
  for (Light& light : scene.lights)
    turn(light, forth);
  for (Texture& texture : scene.textures)
    if (has_trait(texture_types()[static_cast<std::size_t>(texture.type)],
                  kernels::k_trait_position))
      texture.world_to_texture = texture.world_to_texture * back;
}

Vec3 times(Vec3 color, Vec3d gain) {
  return to_float(to_double(color) * gain);
}

void brighten(Scene& scene, Vec3d gain) {
  for (Light& light : scene.lights)
    light.color = times(light.color, gain);
  for (Material& material : scene.materials) {
    if (!material.emits) continue;
    TextureRef& emission = material.emission;
    if (emission.texture < 0) {
      emission.constant = times(emission.constant, gain);
      continue;
    }
    Texture product;
    product.name = material.name + ".emission.gain";
    product.type = find_type(texture_types(), "scale");
    DS_ASSERT(product.type >= 0);
    product.inputs = {emission, TextureRef{times({1, 1, 1}, gain), -1}};
    scene.textures.push_back(std::move(product));
    emission = {{}, static_cast<int>(scene.textures.size()) - 1};
  }
}

}  // namespace

Scene changed(Scene scene, const EnvironmentChange& change) {
  if (change.turn_deg != 0) turn(scene, change.turn_deg);
  const Vec3d gain{change.gain, change.gain, change.gain};
  if (is_gain(change))
    brighten(scene,
             change.temperature_k == 0 ? gain : black_body_colour(change.temperature_k) * gain);
  return scene;
}

bool is_gain(const EnvironmentChange& change) {
  return change.gain != 1 || change.temperature_k != 0;
}

bool gain_changes_program(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
    return material.emits && material.emission.texture >= 0;
  });
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/scene_check.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/type_tables.h"

#include <cmath>
#include <cstddef>

namespace ds {
namespace {

bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool is_near(Vec3 v) {
  const auto near = [](float x) { return std::fabs(double{x}) <= k_farthest_coordinate; };
  return near(v.x) && near(v.y) && near(v.z);  // false for NaN
}
bool is_radiance(Vec3 v) {
  return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
}

bool is_index(int i, std::size_t count) {
  return i >= 0 && static_cast<std::size_t>(i) < count;
}

void check_positions(const Object& object) {
  const Mesh& mesh = object.mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = mesh.positions[v];
    if (!is_near(p))
      fail(ErrorKind::asset, "object {}: vertex {} must be finite and within {:g}, got {} {} {}",
           object.name, v, k_farthest_coordinate, p.x, p.y, p.z);
  }
}

void check_attributes(const Object& object) {
  const Mesh& mesh = object.mesh;
  const auto check_count = [&](const char* what, std::size_t count) {
    if (count != 0 && count != mesh.positions.size())
      fail(ErrorKind::asset, "object {}: must have {} {} as it has vertices, got {}", object.name,
           mesh.positions.size(), what, count);
  };
  check_count("normals", mesh.normals.size());
  check_count("uvs", mesh.uvs.size());
  for (std::size_t v = 0; v < mesh.normals.size(); ++v)
    if (!is_finite(mesh.normals[v]))
      fail(ErrorKind::asset, "object {}: normal {} must be finite", object.name, v);
  for (std::size_t v = 0; v < mesh.uvs.size(); ++v)
    if (!std::isfinite(mesh.uvs[v].x) || !std::isfinite(mesh.uvs[v].y))
      fail(ErrorKind::asset, "object {}: uv {} must be finite", object.name, v);
}

void check_object(const Scene& scene, const Object& object) {
  check_positions(object);
  check_attributes(object);
  for (const auto& triangle : object.mesh.triangles)
    for (const std::uint32_t i : triangle)
      if (i >= object.mesh.positions.size())
        fail(ErrorKind::asset, "object {}: a triangle's index must be below {}, got {}",
             object.name, object.mesh.positions.size(), i);
  if (!is_index(object.material, scene.materials.size()))
    fail(ErrorKind::asset, "object {}: its material must be one of {}, got {}", object.name,
         scene.materials.size(), object.material);
  const auto& own = object.triangle_materials;
  if (!own.empty() && own.size() != object.mesh.triangles.size())
    fail(ErrorKind::asset, "object {}: wanted a material for each of {} triangles, got {}",
         object.name, object.mesh.triangles.size(), own.size());
  for (const std::uint32_t material : own)
    if (material >= scene.materials.size())
      fail(ErrorKind::asset, "object {}: a triangle's material must be one of {}, got {}",
           object.name, scene.materials.size(), material);
}

/// A matrix is kept in double and reaches the tracer in float.
void check_matrix(const Mat4& matrix, const char* kind, const std::string& name, const char* what) {
  for (const double x : matrix.m)
    if (!std::isfinite(static_cast<float>(x)))
      fail(ErrorKind::asset, "{} {}: {} must be finite and within the range of floats, got {:g}",
           kind, name, what, x);
}

/// What textures and materials have in common. `textures`: how many an input may name.
void check_node(const char* kind, const std::string& name, const std::vector<TextureRef>& inputs,
                const std::vector<float>& numbers, std::size_t textures) {
  for (const TextureRef& input : inputs) {
    if (!is_finite(input.constant))
      fail(ErrorKind::asset, "{} {}: a value must be finite, got {} {} {}", kind, name,
           input.constant.x, input.constant.y, input.constant.z);
    if (input.texture != -1 && !is_index(input.texture, textures))
      fail(ErrorKind::asset, "{} {}: an input's texture must be one of {}, got {}", kind, name,
           textures, input.texture);
  }
  for (const float number : numbers)
    if (!std::isfinite(number))
      fail(ErrorKind::asset, "{} {}: a number must be finite, got {}", kind, name, number);
}

/// The texture at `place`: its inputs stand before it.
void check_texture(const Scene& scene, std::size_t place) {
  const Texture& texture = scene.textures[place];
  check_node("texture", texture.name, texture.inputs, texture.numbers, place);
  check_matrix(texture.world_to_texture, "texture", texture.name, "its transformation");
  for (const float x : texture.uv_transform)
    if (!std::isfinite(x))
      fail(ErrorKind::asset, "texture {}: its transformation of uv must be finite, got {}",
           texture.name, x);
  if (texture.image != -1 && !is_index(texture.image, scene.images.size()))
    fail(ErrorKind::asset, "texture {}: its image must be one of {}, got {}", texture.name,
         scene.images.size(), texture.image);
}

/// The material at `place`: its parts stand before it.
void check_material(const Scene& scene, std::size_t place) {
  const Material& material = scene.materials[place];
  check_node("material", material.name, material.inputs, material.numbers, scene.textures.size());
  for (const int child : material.children)
    if (child != -1 && !is_index(child, place))
      fail(ErrorKind::asset, "material {}: a part must be one of the {} before it, got {}",
           material.name, place, child);
  const Vec3 emission = material.emission.constant;
  if (material.emits && !is_radiance(emission))
    fail(ErrorKind::asset, "material {}: emission must be finite and not negative, got {} {} {}",
         material.name, emission.x, emission.y, emission.z);
}

void check_light_value(const Light& light, const LightInput& input) {
  if (input.value == LightValue::color) return;
  if (input.value == LightValue::number) {
    const float number = *light_value(light, input.name);
    if (!std::isfinite(number))
      fail(ErrorKind::asset, "light {}: its {} must be finite, got {}", light.name, input.name,
           number);
    return;
  }
  const Vec3 v = light_vector(light, input.name);
  if (input.value == LightValue::point && !is_near(v))
    fail(ErrorKind::asset, "light {}: its {} must be finite and within {:g}, got {} {} {}",
         light.name, input.name, k_farthest_coordinate, v.x, v.y, v.z);
  if (!is_finite(v))
    fail(ErrorKind::asset, "light {}: its {} must be finite", light.name, input.name);
}

void check_light(const Scene& scene, const Light& light) {
  if (!is_radiance(light.color))
    fail(ErrorKind::asset, "light {}: its colour must be finite and not negative, got {} {} {}",
         light.name, light.color.x, light.color.y, light.color.z);
  const LightType& type = type_of(light);
  for (const LightInput& input : type.host.inputs)
    check_light_value(light, input);
  check_matrix(light.light_to_world, "light", light.name, "its transformation");
  if ((type.host.made_by & kernels::k_host_panorama) != 0 &&
      !is_index(light.image, scene.images.size()))
    fail(ErrorKind::asset, "light {}: its image must be one of {}, got {}", light.name,
         scene.images.size(), light.image);
}

/// Texels already loaded; files are checked as they are decoded (render/images.cc).
void check_image(const Image& image) {
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    if (!(image.rgb[i] >= 0 && std::isfinite(image.rgb[i])))
      fail(ErrorKind::asset, "image {}: texel {} must be finite and not negative, got {}",
           image.file.empty() ? image.made_from : image.file.string(), i / 3, image.rgb[i]);
}

}  // namespace

void check_scene(const Scene& scene) {
  for (const Object& object : scene.objects)
    check_object(scene, object);
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    check_texture(scene, i);
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene, i);
  for (const Light& light : scene.lights)
    check_light(scene, light);
  for (const Image& image : scene.images)
    check_image(image);
}

}  // namespace ds

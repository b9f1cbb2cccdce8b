// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/export_scene.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <nlohmann/json.hpp>

#include <cstring>
#include <span>

namespace ds {
namespace {

using nlohmann::json;

json numbers(Vec3 v) {
  return json::array({v.x, v.y, v.z});
}
json numbers(Vec3d v) {
  return json::array({v.x, v.y, v.z});
}

kernels::real3 to_real3(Vec3 v) {
  return kernels::vec(v.x, v.y, v.z);
}

/// Runs the kernel's function of texture type `row` on the host.
kernels::real3 evaluate_type(std::size_t row, const kernels::TexturePoint& at,
                             const std::vector<float>& numbers,
                             const std::vector<kernels::real3>& inputs) {
  std::size_t next = 0;
#define DS_EVALUATE(sdl_name, prefix, PREFIX) \
  if (row == next++) return kernels::prefix##_evaluate(at, numbers.data(), inputs.data());
  DS_ALL_TEXTURES(DS_EVALUATE)
#undef DS_EVALUATE
  fail(ErrorKind::asset, "texture type {} is not in the list", row);
}

/// The value at a world point.
kernels::real3 evaluate(const Scene& scene, const TextureRef& ref, Vec3 position) {
  if (ref.texture < 0) return to_real3(ref.constant);
  const Texture& texture = scene.textures[static_cast<std::size_t>(ref.texture)];
  if (texture.image >= 0)
    fail(ErrorKind::asset, "texture {}: an image cannot be exported to the peers", texture.name);
  if (reads_colors(texture_types()[static_cast<std::size_t>(texture.type)]))
    fail(ErrorKind::asset, "texture {}: colours of meshes cannot be exported to the peers",
         texture.name);
  std::vector<kernels::real3> inputs;
  for (const TextureRef& input : texture.inputs)
    inputs.push_back(evaluate(scene, input, position));
  kernels::TexturePoint at{};
  at.position = to_real3(to_float(texture.world_to_texture.point(to_double(position))));
  return evaluate_type(static_cast<std::size_t>(texture.type), at, texture.numbers, inputs);
}

void write_floats(const std::filesystem::path& file, const std::vector<float>& values) {
  write_file_atomic(file, std::as_bytes(std::span(values)));
}

template <typename T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

void write_ply(const std::filesystem::path& file, const Mesh& mesh) {
  const bool normals = !mesh.normals.empty();
  std::string ply = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\n{}element face {}\nproperty list uchar int "
      "vertex_indices\nend_header\n",
      mesh.positions.size(),
      normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
      mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      append(ply, mesh.positions[i][axis]);
    for (int axis = 0; normals && axis < 3; ++axis)
      append(ply, mesh.normals[i][axis]);
  }
  for (const auto& triangle : mesh.triangles) {
    append(ply, std::uint8_t{3});
    append(ply, triangle);
  }
  write_file_atomic(file, ply);
}

json export_material(const Material& material) {
  const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
  json inputs = json::object();
  for (std::size_t i = 0; i < material.inputs.size(); ++i)
    inputs[std::string(type.inputs[i].name)] = numbers(material.inputs[i].constant);
  return {{"name", material.name}, {"type", std::string(type.name)}, {"inputs", inputs}};
}

/// Writes the object's files; its entry names the inputs that vary over it.
json export_object(const Scene& scene, std::size_t index, const std::filesystem::path& folder) {
  const Object& object = scene.objects[index];
  const std::string stem = fmt::format("object-{}", index);
  write_ply(folder / (stem + ".ply"), object.mesh);
  if (object.id == k_model_object_id) write_ply(folder / "model.ply", object.mesh);

  const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
  const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
  json varying = json::object();
  for (std::size_t i = 0; i < material.inputs.size(); ++i) {
    if (material.inputs[i].texture < 0) continue;
    std::vector<float> values;
    for (const Vec3 position : object.mesh.positions) {
      const kernels::real3 value = evaluate(scene, material.inputs[i], position);
      values.insert(values.end(), {value.x, value.y, value.z});
    }
    const std::string file = fmt::format("{}.{}.f32", stem, type.inputs[i].name);
    write_floats(folder / file, values);
    varying[std::string(type.inputs[i].name)] = file;
  }
  return {{"name", object.name},
          {"file", stem + ".ply"},
          {"material", object.material},
          {"varying", varying},
          {"triangles", object.mesh.triangles.size()}};
}

json export_light(const Scene& scene, const Light& light, const std::filesystem::path& folder) {
  json entry = {{"name", light.name},
                {"kind", type_of(light).kernel_prefix},
                {"color", numbers(light.color)},
                {"light_to_world", light.light_to_world.m}};
  for (const LightInput& input : type_of(light).host.inputs)
    if (input.value == LightValue::number)
      entry[std::string(input.name)] = *light_value(light, input.name);
    else if (input.value != LightValue::color)
      entry[std::string(input.name)] = numbers(light_vector(light, input.name));
  if (light.image < 0) return entry;
  const Image& image = scene.images[static_cast<std::size_t>(light.image)];
  const std::string file = fmt::format("image-{}.f32", light.image);
  write_floats(folder / file, image.rgb);
  entry["image"] = {{"file", file}, {"width", image.width}, {"height", image.height}};
  return entry;
}

json export_camera(const Camera& camera) {
  return {{"position", numbers(camera.position)},
          {"target", numbers(camera.target)},
          {"up", numbers(camera.up)},
          {"fov_deg", camera.fov_deg}};
}

json export_engine(const EngineSettings& engine) {
  return {{"depth_total", engine.depth_total},       {"depth_diffuse", engine.depth_diffuse},
          {"depth_glossy", engine.depth_glossy},     {"depth_specular", engine.depth_specular},
          {"roulette_depth", engine.roulette_depth}, {"roulette_cap", engine.roulette_cap},
          {"filter_width", engine.filter_width}};
}

}  // namespace

void export_scene(const Scene& scene, const Camera& camera, const EngineSettings& engine,
                  const std::filesystem::path& folder) {
  make_folders(folder);
  json objects = json::array(), materials = json::array(), lights = json::array();
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    objects.push_back(export_object(scene, i, folder));
  for (const Material& material : scene.materials)
    materials.push_back(export_material(material));
  for (const Light& light : scene.lights)
    lights.push_back(export_light(scene, light, folder));
  const json all = {{"camera", export_camera(camera)},
                    {"engine", export_engine(engine)},
                    {"objects", objects},
                    {"materials", materials},
                    {"lights", lights}};
  write_file_atomic(folder / "scene.json", all.dump(1) + "\n");
}

}  // namespace ds

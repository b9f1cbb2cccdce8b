// SPDX-License-Identifier: Apache-2.0
// Planes of a picture that ask no light: the tracer's pass of one ray a pixel.
#include "tracer/base/error.h"
#include "tracer/render/tracer_state.h"
#include "tracer/render/view.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <span>

namespace ds {
namespace {

/// The object of that id, as if it were the model, in a scene of nothing else, and of no texture or light.
/// Without a triangle where there is none.
Scene object_alone(const Scene& scene, std::uint32_t id) {
  Scene alone;
  Material& matte = alone.materials.emplace_back();
  const NodeType& type = material_types()[static_cast<std::size_t>(matte.type)];
  for (const InputType& input : type.inputs)
    matte.inputs.push_back({{input.default_value, input.default_value, input.default_value}, -1});
  for (const NumberType& number : type.numbers)
    matte.numbers.push_back(number.default_value);
  for (const Object& object : scene.objects) {
    if (object.id != id) continue;
    alone.objects.push_back(object);
    alone.objects.back().id = k_model_object_id;
    alone.objects.back().material = 0;
    alone.objects.back().triangle_materials.clear();
  }
  return alone;
}

bool has_triangles(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return !object.mesh.triangles.empty(); });
}

/// Of all zeros.
Plane empty_plane(const PlaneType& type, int width, int height) {
  return {&type, width, height,
          std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                             static_cast<std::size_t>(type.width))};
}

bool read_materials(const std::vector<const PlaneType*>& types) {
  return std::any_of(types.begin(), types.end(),
                     [](const PlaneType* type) { return reads_materials(*type); });
}

/// Work-items of a picture's planes.
std::size_t tile_count(const kernels::ViewData& view, int lanes) {
  const auto width = kernels::tile_width(static_cast<kernels::uint>(lanes));
  const auto height = kernels::tile_height(static_cast<kernels::uint>(lanes));
  return std::size_t{(view.width + width - 1) / width} * ((view.height + height - 1) / height);
}

std::vector<std::uint32_t> material_ids(const Scene& scene) {
  std::vector<std::uint32_t> ids;
  for (const Material& material : scene.materials)
    ids.push_back(material.id);
  return ids;
}

}  // namespace

Kernel& Tracer::State::plane_kernel(const std::vector<const PlaneType*>& types) {
  std::optional<SceneEffects> effects;
  if (read_materials(types)) effects = packed_for;
  for (PlaneKernel& known : plane_kernels)
    if (known.types == types && known.effects == effects) return known.kernel;
  const Program program = device.build(
      planes_program_text(types, effects.value_or(SceneEffects{})),
      fmt::format("{} -DDS_LANES={}", k_strict_options, plane_lanes()), options.cache_folder);
  plane_kernels.push_back({types, effects, device.kernel(program, "trace_planes")});
  return plane_kernels.back().kernel;
}

std::vector<Plane> Tracer::State::launch_planes(const DeviceScene& of, const Scene& seen,
                                                const Camera& camera, int width, int height,
                                                const std::vector<const PlaneType*>& types) {
  EngineSettings size;
  size.width = width;
  size.height = height;
  const kernels::ViewData view = view_data(camera, size, ray_start_m(seen, camera, width, height));
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  int numbers = 0;
  for (const PlaneType* type : types)
    numbers += type->width;
  const Buffer view_buffer = device.upload(std::as_bytes(std::span(&view, 1)));
  const std::size_t bytes = pixels * static_cast<std::size_t>(numbers) * sizeof(float);
  if (plane_numbers.size_bytes() < bytes) plane_numbers = device.make_buffer(bytes);
  const Buffer ids = device.upload(material_ids(seen));
  Kernel& kernel = plane_kernel(types);
  unsigned argument = 0;
  for (const Buffer& b :
       {of.nodes, of.leaves, of.triangles, ids, view_buffer, of.data, plane_numbers})
    kernel.set(argument++, b);
  if (read_materials(types))
    for (const Buffer* b : {&of.materials, &of.texture_code, &of.tables})
      kernel.set(argument++, *b);
  device.run(kernel, 0, round_up(tile_count(view, plane_lanes()), local_size), local_size);
  if (options.count_rays) ray_counts.geometry += pixels;
  std::vector<Plane> result;
  std::size_t offset = 0;
  for (const PlaneType* type : types) {
    std::vector<float> values(pixels * static_cast<std::size_t>(type->width));
    device.read(plane_numbers, std::as_writable_bytes(std::span(values)), offset);
    offset += values.size() * sizeof(float);
    result.push_back({type, width, height, std::move(values)});
  }
  return result;
}

std::vector<Plane> Tracer::trace_planes(const Camera& camera, int width, int height,
                                        const std::vector<const PlaneType*>& types) {
  State& s = *state_;
  if (!s.ready) fail(ErrorKind::device, "no scene was set before tracing");
  std::vector<const PlaneType*> of_scene, of_model;
  for (const PlaneType* type : types)
    ((type->traits & kernels::k_plane_alone) != 0 ? of_model : of_scene).push_back(type);
  std::vector<Plane> traced, of_alone;
  if (!of_scene.empty()) {
    if (read_materials(of_scene))
      s.take_materials(camera);
    else
      s.take_surfaces();
    traced = s.launch_planes(s.device_scene, s.scene(), camera, width, height, of_scene);
  }
  if (!of_model.empty()) {
    const Scene alone = object_alone(s.scene(), k_model_object_id);
    if (has_triangles(alone)) {
      if (!s.device_model) {
        DeviceScene model;
        model.take(s.device, s.maker.pack_surfaces(alone), s.uploads);
        s.device_model = model;
      }
      of_alone = s.launch_planes(*s.device_model, alone, camera, width, height, of_model);
    } else {
      for (const PlaneType* type : of_model)
        of_alone.push_back(empty_plane(*type, width, height));
    }
  }
  std::vector<Plane> planes;
  auto next = traced.begin(), next_alone = of_alone.begin();
  for (const PlaneType* type : types)
    planes.push_back(
        std::move((type->traits & kernels::k_plane_alone) != 0 ? *next_alone++ : *next++));
  return planes;
}

std::vector<Plane> Tracer::trace_alone(const Camera& camera, int width, int height,
                                       const std::vector<std::uint32_t>& ids) {
  State& s = *state_;
  if (!s.ready) fail(ErrorKind::device, "no scene was set before tracing");
  const PlaneType& type = plane_type("amodal_mask");
  std::vector<Plane> masks;
  for (const std::uint32_t id : ids) {
    const Scene alone = object_alone(s.scene(), id);
    if (!has_triangles(alone)) {
      masks.push_back(empty_plane(type, width, height));
      continue;
    }
    DeviceScene object;
    object.take(s.device, s.maker.pack_surfaces(alone), s.uploads);
    masks.push_back(
        std::move(s.launch_planes(object, alone, camera, width, height, {&type}).front()));
  }
  return masks;
}

Geometry Tracer::trace_geometry(const Camera& camera, int width, int height) {
  std::vector<Plane> planes =
      trace_planes(camera, width, height, {&plane_type("mask"), &plane_type("depth")});
  Geometry geometry{width, height, {}, std::move(planes[1].values)};
  geometry.mask.reserve(planes[0].values.size());
  for (const float covered : planes[0].values)
    geometry.mask.push_back(covered > 0 ? 255 : 0);
  return geometry;
}

}  // namespace ds

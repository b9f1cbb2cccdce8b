// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/scene_pack.h"

#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"
#include "tracer/device/pack_rows.h"
#include "tracer/device/texture_code.h"
#include "tracer/device/ties.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

std::vector<Corners> corners_of(const Scene& scene) {
  std::vector<Corners> corners;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = object.mesh;
    for (const auto& t : mesh.triangles)
      corners.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  if (corners.empty()) fail(ErrorKind::asset, "the scene has no triangle");
  return corners;
}

/// Unit normal, in double so that no triangle is too small; zero for one without area.
Vec3 face_normal(const Corners& c) {
  return to_float(
      normalized(cross(to_double(c[1]) - to_double(c[0]), to_double(c[2]) - to_double(c[0]))));
}

/// A vertex' stored normal as the normal of one triangle's corner. It tells a line; which way along
/// it is out, the triangle's own side tells: files hold normals against their winding, and a vertex
/// may belong to triangles of both windings. So all corners' normals, and what is interpolated of
/// them, are on the triangle's own side.
Vec3 corner_normal(const Mesh& mesh, std::uint32_t vertex, Vec3 own) {
  const Vec3 stored = mesh.normals.empty() ? Vec3{} : mesh.normals[vertex];
  if (stored == Vec3{}) return own;
  return dot(to_double(stored), to_double(own)) < 0 ? -stored : stored;
}

TriangleRows rows_of(const Object& object, std::uint32_t light) {
  const Mesh& mesh = object.mesh;
  TriangleRows rows;
  Words& out = rows.words;
  out.reserve(mesh.triangles.size() * kernels::k_triangle_words);
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const auto& t = mesh.triangles[triangle];
    const Corners corners = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    for (const Vec3& p : corners)
      out.add(p);
    const Vec3 own = face_normal(corners);
    for (const std::uint32_t i : t)
      out.add(corner_normal(mesh, i, own));
    for (const std::uint32_t i : t) {
      out.add(mesh.uvs.empty() ? 0.0f : mesh.uvs[i].x);
      out.add(mesh.uvs.empty() ? 0.0f : mesh.uvs[i].y);
    }
    out.add(static_cast<std::uint32_t>(material_of_triangle(object, triangle)));
    out.add(light);
    out.add(object.id);
    out.add(object.camera_invisible ? std::uint32_t{kernels::k_flag_camera_invisible} : 0u);
  }
  return rows;
}

/// Of all that rows_of reads.
Hash128 hash_of_rows(const Object& object, std::uint32_t light) {
  const auto hash = [](const auto& values) { return hash_bytes(std::as_bytes(std::span(values))); };
  HashStream stream;
  stream.add(hash(object.mesh.positions));
  stream.add(hash(object.mesh.normals));
  stream.add(hash(object.mesh.uvs));
  stream.add(hash(object.mesh.triangles));
  stream.add(hash(object.triangle_materials));
  stream.add(fmt::format("{} {} {} {}", object.material, light, object.id,
                         static_cast<int>(object.camera_invisible)));
  return stream.hash();
}

/// Offsets in tables of the texels of images that textures show; each image once. Infinite lights
/// have tables of their own.
std::vector<std::uint32_t> pack_texels(const Scene& scene, Words& tables) {
  std::vector<bool> shown(scene.images.size(), false);
  for (const Texture& texture : scene.textures)
    if (texture.image >= 0) shown[static_cast<std::size_t>(texture.image)] = true;
  std::vector<std::uint32_t> offsets;
  for (const Image& image : scene.images) {
    DS_ASSERT(image.width > 0 && image.rgb.size() == std::size_t{3} *
                                                         static_cast<std::size_t>(image.width) *
                                                         static_cast<std::size_t>(image.height));
    const bool is_shown = shown[offsets.size()];
    offsets.push_back(tables.offset());
    if (is_shown) tables.add(std::span(image.rgb));
  }
  return offsets;
}

/// The material's program with the scene's numbers put in; its offset, or k_none.
std::uint32_t pack_texture_code(const Scene& scene, const Material& material,
                                const SceneEffects& effects,
                                const std::vector<std::uint32_t>& texels, std::uint32_t colors,
                                Words& out) {
  TextureCode code = texture_code(scene, material);
  if (code.words.empty()) return k_none;
  for (const std::size_t i : code.op_words) {
    const std::size_t row = code.words[i] - std::uint32_t{kernels::op_texture};
    const int number = SceneEffects::number(effects.textures, texture_types()[row].kernel_prefix);
    code.words[i] = std::uint32_t{kernels::op_texture} + static_cast<std::uint32_t>(number);
  }
  for (const std::size_t i : code.image_words)
    code.words[i] = texels[code.words[i]];
  for (const std::size_t i : code.color_words)
    code.words[i] = colors;
  const std::uint32_t offset = out.offset();
  for (const std::uint32_t word : code.words)
    out.add(word);
  return offset;
}

void pack_inputs(const Material& material, Words& out) {
  const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
  for (std::size_t i = 0; i < type.inputs.size(); ++i) {
    const Vec3 value = material.inputs[i].texture < 0 ? material.inputs[i].constant : Vec3{};
    out.add(value.x);
    if (type.inputs[i].width == 3) {
      out.add(value.y);
      out.add(value.z);
    }
  }
  for (const float number : material.numbers)
    out.add(number);
}

void pack_materials(const Scene& scene, const SceneEffects& effects,
                    const std::vector<std::uint32_t>& texels, std::uint32_t colors,
                    PackedScene& packed) {
  const auto row_words =
      static_cast<std::uint32_t>(kernels::k_material_head + effects.material_inputs);
  packed.data.material_words = row_words;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const std::string_view prefix =
        material_types()[static_cast<std::size_t>(material.type)].kernel_prefix;
    Words& out = packed.materials;
    const int number = SceneEffects::number(effects.materials, prefix);
    const int chooser = SceneEffects::number(effects.choosers, prefix);
    // A material that nothing shows has no number.
    out.add(number >= 0 ? static_cast<std::uint32_t>(number)
                        : static_cast<std::uint32_t>(effects.materials.size()) +
                              static_cast<std::uint32_t>(std::max(chooser, 0)));
    out.add(pack_texture_code(scene, material, effects, texels, colors, packed.texture_code));
    for (const int child : material.children)
      out.add(static_cast<std::uint32_t>(std::max(child, 0)));
    out.add(material.emission.constant);
    out.pad_to(i * row_words + kernels::k_material_head);
    if (number >= 0 || chooser >= 0) pack_inputs(material, out);
    out.pad_to((i + 1) * row_words);
  }
}

Bvh tree_of(const Scene& scene, std::span<const Corners> corners, BvhQuality quality, int bvh_width,
            PackCache* cache) {
  // The model comes last (compose), and is all that scenes of one environment differ in.
  if (cache == nullptr || scene.objects.back().id != k_model_object_id)
    return build_bvh(corners, quality, bvh_width);
  return build_joined_bvh(corners, first_triangles(scene).back(), quality, bvh_width, cache->trees);
}

/// `mesh_lights`: as pack_lights gives them. The tree must be there.
void pack_triangles(const Scene& scene, std::span<const Corners> corners,
                    const std::vector<std::uint32_t>& mesh_lights, PackCache* cache,
                    PackedScene& packed) {
  packed.triangles.reserve(corners.size() * kernels::k_triangle_words);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const auto make = [&] { return rows_of(object, mesh_lights[i]); };
    // The last is the model, which scenes do not have in common.
    const bool shared = cache != nullptr && i + 1 < scene.objects.size();
    packed.triangles.add((shared ? cache->rows.get(hash_of_rows(object, mesh_lights[i]), make)
                                 : std::make_shared<const TriangleRows>(make()))
                             ->words);
  }
  const Ties ties =
      find_ties(scene, corners, packed.bvh, cache != nullptr ? &cache->ties : nullptr);
  packed.data.tie_places = static_cast<std::uint32_t>(ties.places.size());
  for (std::size_t i = 0; i < ties.places.size(); ++i) {
    std::copy(ties.places[i].low.begin(), ties.places[i].low.end(), packed.data.tie_low[i]);
    std::copy(ties.places[i].high.begin(), ties.places[i].high.end(), packed.data.tie_high[i]);
  }
  for (std::size_t i = 0; i < ties.flags.size(); ++i)
    if (ties.flags[i] != 0)
      packed.triangles.at(i * kernels::k_triangle_words + kernels::k_triangle_flags) |=
          ties.flags[i];
}

}  // namespace

std::vector<std::uint32_t> first_triangles(const Scene& scene) {
  std::vector<std::uint32_t> first;
  std::uint32_t count = 0;
  for (const Object& object : scene.objects) {
    first.push_back(count);
    count += static_cast<std::uint32_t>(object.mesh.triangles.size());
  }
  return first;
}

PackedScene pack_scene(const Scene& scene, const SceneEffects& effects, BvhQuality quality,
                       int bvh_width, PackCache* cache) {
  const std::vector<Corners> corners = corners_of(scene);
  PackedScene packed;
  const std::vector<std::uint32_t> texels = pack_texels(scene, packed.tables);
  const std::uint32_t colors = pack_colors(scene, effects, packed.tables);
  pack_materials(scene, effects, texels, colors, packed);
  std::vector<std::uint32_t> mesh_lights;
  pack_lights(scene, effects, cache, packed, mesh_lights);
  packed.bvh = tree_of(scene, corners, quality, bvh_width, cache);
  pack_triangles(scene, corners, mesh_lights, cache, packed);
  return packed;
}

PackedScene pack_surfaces(const Scene& scene, BvhQuality quality, int bvh_width, PackCache* cache) {
  const std::vector<Corners> corners = corners_of(scene);
  PackedScene packed;
  packed.bvh = tree_of(scene, corners, quality, bvh_width, cache);
  pack_triangles(scene, corners, std::vector<std::uint32_t>(scene.objects.size(), k_none), cache,
                 packed);
  return packed;
}

}  // namespace ds

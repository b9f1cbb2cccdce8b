// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/scene_pack.h"

#include "tracer/base/error.h"
#include "tracer/device/pack_rows.h"
#include "tracer/device/texture_code.h"
#include "tracer/device/ties.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ds {
namespace {

using Corners = std::array<Vec3, 3>;

std::vector<Corners> all_corners(const Scene& scene) {
  std::vector<Corners> corners;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = object.mesh;
    for (const auto& t : mesh.triangles)
      corners.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
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

/// `tied`: Ties::flags from the object's first triangle on.
void pack_object(const Object& object, std::uint32_t light, const std::uint32_t* tied, Words& out) {
  const Mesh& mesh = object.mesh;
  for (const auto& t : mesh.triangles) {
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
    out.add(static_cast<std::uint32_t>(object.material));
    out.add(light);
    out.add(object.id);
    out.add(*tied++ |
            (object.camera_invisible ? std::uint32_t{kernels::k_flag_camera_invisible} : 0u));
  }
}

/// Offsets in tables of the images' texels; each image once. Infinite lights take theirs from here
/// too.
std::vector<std::uint32_t> pack_texels(const Scene& scene, Words& tables) {
  std::vector<std::uint32_t> offsets;
  for (const Image& image : scene.images) {
    DS_ASSERT(image.width > 0 && image.rgb.size() == std::size_t{3} *
                                                         static_cast<std::size_t>(image.width) *
                                                         static_cast<std::size_t>(image.height));
    offsets.push_back(tables.offset());
    tables.add(std::span(image.rgb));
  }
  return offsets;
}

/// The material's program with the scene's numbers put in; its offset, or k_none.
std::uint32_t pack_program(const Scene& scene, const Material& material, const Features& features,
                           const std::vector<std::uint32_t>& texels, std::uint32_t colors,
                           Words& programs) {
  TextureCode code = texture_code(scene, material);
  if (code.words.empty()) return k_none;
  for (const std::size_t i : code.op_words) {
    const std::size_t row = code.words[i] - std::uint32_t{kernels::op_texture};
    const int number = Features::number(features.textures, texture_types()[row].kernel_prefix);
    code.words[i] = std::uint32_t{kernels::op_texture} + static_cast<std::uint32_t>(number);
  }
  for (const std::size_t i : code.image_words)
    code.words[i] = texels[code.words[i]];
  for (const std::size_t i : code.color_words)
    code.words[i] = colors;
  const std::uint32_t offset = programs.offset();
  for (const std::uint32_t word : code.words)
    programs.add(word);
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

void pack_materials(const Scene& scene, const Features& features,
                    const std::vector<std::uint32_t>& texels, std::uint32_t colors,
                    PackedScene& packed) {
  const auto row_words =
      static_cast<std::uint32_t>(kernels::k_material_head + features.material_inputs);
  packed.data.material_words = row_words;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const std::string_view prefix =
        material_types()[static_cast<std::size_t>(material.type)].kernel_prefix;
    Words& out = packed.materials;
    const int number = Features::number(features.materials, prefix);
    const int chooser = Features::number(features.choosers, prefix);
    // A material that nothing shows has no number.
    out.add(number >= 0 ? static_cast<std::uint32_t>(number)
                        : static_cast<std::uint32_t>(features.materials.size()) +
                              static_cast<std::uint32_t>(std::max(chooser, 0)));
    out.add(pack_program(scene, material, features, texels, colors, packed.programs));
    for (const int child : material.children)
      out.add(static_cast<std::uint32_t>(std::max(child, 0)));
    out.add(material.emission.constant);
    out.pad_to(i * row_words + kernels::k_material_head);
    if (number >= 0 || chooser >= 0) pack_inputs(material, out);
    out.pad_to((i + 1) * row_words);
  }
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

PackedScene pack_scene(const Scene& scene, const Features& features, BvhQuality quality,
                       int bvh_width, PackCache* cache) {
  const std::vector<Corners> corners = all_corners(scene);
  if (corners.empty()) fail(ErrorKind::asset, "the scene has no triangle");
  PackedScene packed;
  const std::vector<std::uint32_t> first = first_triangles(scene);
  // The model comes last (compose), and is all that scenes of one environment differ in.
  const bool has_model = scene.objects.back().id == k_model_object_id;
  packed.bvh = cache != nullptr && has_model
                   ? build_joined_bvh(corners, first.back(), quality, bvh_width, cache->trees)
                   : build_bvh(corners, quality, bvh_width);
  const std::vector<std::uint32_t> texels = pack_texels(scene, packed.tables);
  const std::uint32_t colors = pack_colors(scene, features, packed.tables);
  pack_materials(scene, features, texels, colors, packed);
  std::vector<std::uint32_t> mesh_lights;
  pack_lights(scene, features, cache, packed, mesh_lights);
  const Ties ties = find_ties(scene, corners, packed.bvh);
  std::copy(ties.low.begin(), ties.low.end(), packed.data.tie_low);
  std::copy(ties.high.begin(), ties.high.end(), packed.data.tie_high);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    pack_object(scene.objects[i], mesh_lights[i], ties.flags.data() + first[i], packed.triangles);
  return packed;
}

}  // namespace ds

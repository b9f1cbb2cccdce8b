// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/texture_mean.h"

#include "builder/measure/spread.h"
#include "tracer/kernels/lists.h"

// Every texture, numbered as the rows of texture_types().
#define DS_ROW(sdl_name, prefix, PREFIX) row_##prefix,
enum { DS_ALL_TEXTURES(DS_ROW) row_count };
#define DS_ROW_CASE(sdl_name, prefix, PREFIX) \
  DS_TEXTURE_CASE(prefix, static_cast<int>(row_##prefix))
#define DS_TEXTURES(X) DS_ALL_TEXTURES(DS_ROW_CASE)
#define DS_TEXTURE_STACK 32
#include "tracer/device/texture_code.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace ds {
namespace {

static_assert(DS_TEXTURE_STACK == k_texture_stack_limit);

using CornerColors = std::array<MeshColor, 3>;
static_assert(sizeof(CornerColors) == kernels::k_color_words * sizeof(float));

/// Of the mesh's corners; white where it has none.
CornerColors colors_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  constexpr MeshColor k_white{1, 1, 1, 1};
  CornerColors colors{k_white, k_white, k_white};
  for (std::size_t i = 0; i < 3 && !mesh.colors.empty(); ++i)
    colors[i] = mesh.colors[corners[i]];
  return colors;
}

/// A point of a triangle, as the kernels' textures see it.
struct Place {
  Vec3 position;
  Vec2 uv;
  float b1, b2;
  CornerColors colors;
};

/// A texture's program and the tables it reads: a row of colours, then the images' texels.
class TextureProgram {
 public:
  TextureProgram(const Scene& scene, int texture) {
    Material material;
    material.type = find_type(material_types(), "matte");
    const NodeType& matte = material_types()[static_cast<std::size_t>(material.type)];
    material.inputs.resize(matte.inputs.size());
    material.inputs[static_cast<std::size_t>(find_input(matte, "kd"))].texture = texture;
    TextureCode code = texture_code(scene, material);
    tables_.resize(kernels::k_color_words);
    std::vector<std::uint32_t> offsets;
    for (const Image& image : scene.images) {
      offsets.push_back(static_cast<std::uint32_t>(tables_.size()));
      tables_.insert(tables_.end(), image.rgb.begin(), image.rgb.end());
    }
    for (const std::size_t i : code.image_words)
      code.words[i] = offsets[code.words[i]];
    for (const std::uint32_t word : code.words)
      words_.push_back(std::bit_cast<float>(word));
  }

  Vec3 at(const Place& place) {
    for (std::size_t i = 0; i < 3; ++i)
      std::copy(place.colors[i].begin(), place.colors[i].end(),
                tables_.begin() + 4 * static_cast<std::ptrdiff_t>(i));
    const Vec3 p = place.position;
    std::array<float, 64> inputs{};
    kernels::run_texture_program(
        words_.data(), tables_.data(),
        {kernels::vec(p.x, p.y, p.z), place.uv.x, place.uv.y, place.b1, place.b2, 0}, true,
        inputs.data());
    return {inputs[0], inputs[1], inputs[2]};
  }

 private:
  std::vector<float> words_, tables_;
};

double area(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners) {
  const auto at = [&](std::size_t i) { return to_double(mesh.positions[corners[i]]); };
  return 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
}

struct Patch {
  const Mesh* mesh;
  std::array<std::uint32_t, 3> corners;
  double area_until;  ///< of all patches up to and with this one
};

/// As uses_texture, of a material or of what it is mixed of.
bool shows_texture(const Scene& scene, int material, int texture) {
  if (material < 0) return false;
  const Material& m = scene.materials[static_cast<std::size_t>(material)];
  return uses_texture(m, texture) || shows_texture(scene, m.children[0], texture) ||
         shows_texture(scene, m.children[1], texture);
}

std::vector<Patch> patches_with(const Scene& scene, int texture) {
  std::vector<Patch> patches;
  double sum = 0;
  for (const Object& object : scene.objects) {
    std::set<int> showing;
    for (const int material : shown_materials(object))
      if (shows_texture(scene, material, texture)) showing.insert(material);
    for (std::size_t i = 0; i < object.mesh.triangles.size(); ++i) {
      if (!showing.contains(material_of_triangle(object, i))) continue;
      const auto& corners = object.mesh.triangles[i];
      sum += area(object.mesh, corners);
      patches.push_back({&object.mesh, corners, sum});
    }
  }
  return patches;
}

}  // namespace

bool uses_texture(const Material& material, int texture) {
  const auto is_it = [&](const TextureRef& input) { return input.texture == texture; };
  return std::any_of(material.inputs.begin(), material.inputs.end(), is_it) ||
         (material.emits && is_it(material.emission));
}

std::optional<Vec3> texture_mean(const Scene& scene, int texture, int points) {
  const std::vector<Patch> patches = patches_with(scene, texture);
  if (patches.empty() || patches.back().area_until <= 0) return std::nullopt;
  TextureProgram program(scene, texture);
  Vec3d sum{};
  for (int i = 0; i < points; ++i) {
    // The first three numbers of the R3 sequence (Roberts 2018), of even cover in three dimensions.
    const double where = spread(i, 0.8191725133961645) * patches.back().area_until;
    const auto patch = std::lower_bound(patches.begin(), patches.end(), where,
                                        [](const Patch& p, double a) { return p.area_until < a; });
    const double root = std::sqrt(spread(i, 0.6710436067037893));
    const double v = spread(i, 0.5497004779019703);
    const double weights[3] = {1 - root, root * (1 - v), root * v};
    Vec3d position{};
    Vec2 uv{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = patch->corners[k];
      position = position + weights[k] * to_double(patch->mesh->positions[corner]);
      if (patch->mesh->uvs.empty()) continue;
      uv.x += static_cast<float>(weights[k]) * patch->mesh->uvs[corner].x;
      uv.y += static_cast<float>(weights[k]) * patch->mesh->uvs[corner].y;
    }
    sum = sum + to_double(program.at({to_float(position), uv, static_cast<float>(weights[1]),
                                      static_cast<float>(weights[2]),
                                      colors_of(*patch->mesh, patch->corners)}));
  }
  return to_float((1.0 / points) * sum);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/device/pack_rows.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <span>

namespace ds {

void add_cumulative(const std::vector<double>& weights, Words& tables) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double sum = 0;
  std::size_t last_positive = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) last_positive = i;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    tables.add(i >= last_positive || total <= 0 ? 1.0f
                                                : std::min(static_cast<float>(sum / total), 1.0f));
  }
}

namespace {

/// What a scene says of a light, in the table's order.
std::vector<float> inputs_of(const Light& light) {
  std::vector<float> inputs{light.color.x, light.color.y, light.color.z};
  inputs.insert(inputs.end(), light.values.begin(), light.values.end());
  return inputs;
}

LightRow row_of_inputs(const Light& light, double scene_radius) {
  const LightType& type = type_of(light);
  const std::vector<float> inputs = inputs_of(light);
  LightRow row{type.kernel_prefix, 0, {}};
  if (type.host.power != nullptr)
    row.weight = type.host.power(luminance(light.color), inputs.data(), scene_radius);
  if (type.host.row != nullptr) {
    std::array<float, kernels::k_light_words - kernels::k_light_parameters> words{};
    type.host.row(inputs.data(), words.data());
    row.parameters.add(std::span<const float>(words));
  } else {
    row.parameters.add(std::span<const float>(inputs));
  }
  return row;
}

LightRow mesh_row(const Scene& scene, const Object& object, std::uint32_t first_triangle,
                  Words& tables) {
  const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
  if (material.emission.texture >= 0)
    fail(ErrorKind::asset, "material {}: textured emission is not supported yet", material.name);
  std::vector<double> areas;
  for (const auto& t : object.mesh.triangles) {
    const Vec3d p0 = to_double(object.mesh.positions[t[0]]);
    areas.push_back(0.5 * length(cross(to_double(object.mesh.positions[t[1]]) - p0,
                                       to_double(object.mesh.positions[t[2]]) - p0)));
  }
  DS_ASSERT(!areas.empty());  // find_interval wants one
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  LightRow row{"mesh", luminance(material.emission.constant) * area * std::numbers::pi, {}};
  row.parameters.add(material.emission.constant);
  row.parameters.add(static_cast<float>(area));
  row.parameters.add(static_cast<std::uint32_t>(areas.size()));
  row.parameters.add(tables.offset());
  add_cumulative(areas, tables);
  row.parameters.add(tables.offset());
  for (std::uint32_t i = 0; i < areas.size(); ++i)
    tables.add(first_triangle + i);
  return row;
}

/// Half the diagonal of the objects' bounds; the power of lights at infinity is what falls on a
/// disc of this radius.
double scene_radius_of(const Scene& scene) {
  Vec3d low{1e300, 1e300, 1e300};
  Vec3d high{-1e300, -1e300, -1e300};
  for (const Object& object : scene.objects)
    for (const Vec3& p : object.mesh.positions) {
      low = {std::min(low.x, double{p.x}), std::min(low.y, double{p.y}),
             std::min(low.z, double{p.z})};
      high = {std::max(high.x, double{p.x}), std::max(high.y, double{p.y}),
              std::max(high.z, double{p.z})};
    }
  return 0.5 * length(high - low);
}

LightRow light_row(const Scene& scene, const Light& light, double radius, PackCache* cache,
                   Words& tables) {
#define DS_PACK_WITH_TABLES(sdl_name, prefix)                                      \
  if constexpr ((kernels::prefix##_on_host.made_by & kernels::k_host_tables) != 0) \
    if (type_of(light).kernel_prefix == #prefix)                                   \
      return pack_##prefix(scene, light, radius, cache, tables);
  DS_SCENE_LIGHTS(DS_PACK_WITH_TABLES)
  return row_of_inputs(light, radius);
}

bool is_escape(const SceneEffects& effects, const LightRow& row) {
  return SceneEffects::number(effects.escape_lights, row.kind) >= 0;
}

}  // namespace

void pack_lights(const Scene& scene, const SceneEffects& effects, PackCache* cache,
                 PackedScene& packed, std::vector<std::uint32_t>& mesh_lights) {
  const double radius = scene_radius_of(scene);
  const std::vector<std::uint32_t> first = first_triangles(scene);
  std::vector<LightRow> rows;
  mesh_lights.assign(scene.objects.size(), k_none);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.material < 0 || !shines(scene.materials[static_cast<std::size_t>(object.material)]))
      continue;
    mesh_lights[i] = static_cast<std::uint32_t>(rows.size());
    rows.push_back(mesh_row(scene, object, first[i], packed.tables));
  }
  for (const Light& light : scene.lights)
    if (shines(light)) rows.push_back(light_row(scene, light, radius, cache, packed.tables));
  std::stable_partition(rows.begin(), rows.end(),
                        [&](const LightRow& row) { return !is_escape(effects, row); });

  // Power says little about what reaches a point: mixed half and half with equal shares, no light
  // is starved.
  double total = 0;
  std::size_t sampled = 0;
  for (const LightRow& row : rows) {
    total += row.weight;
    sampled += row.weight > 0 ? 1 : 0;
  }
  const bool each = rows.size() <= kernels::k_most_rounds;
  std::vector<double> shares;
  for (const LightRow& row : rows)
    shares.push_back(row.weight <= 0 ? 0.0
                     : each          ? 1.0
                                     : 0.5 * row.weight / total + 0.5 / double(sampled));

  packed.data.light_count = static_cast<std::uint32_t>(rows.size());
  packed.data.first_escape_light = packed.data.light_count;
  packed.data.light_rounds = each ? packed.data.light_count : 1;
  packed.data.light_table = packed.tables.offset();
  add_cumulative(shares, packed.tables);
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const LightRow& row = rows[i];
    if (is_escape(effects, row))
      packed.data.first_escape_light = std::min(packed.data.first_escape_light, i);
    packed.lights.add(static_cast<std::uint32_t>(SceneEffects::number(effects.lights, row.kind)));
    packed.lights.add(static_cast<float>(shares[i]));
    for (const std::uint32_t word : row.parameters.words())
      packed.lights.add(word);
    packed.lights.pad_to((i + 1) * std::size_t{kernels::k_light_words});
  }
}

}  // namespace ds

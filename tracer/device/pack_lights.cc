// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/base/luminance.h"
#include "tracer/device/pack_rows.h"
#include "tracer/kernels/all_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

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

LightRow sun_row(const Light& light, double scene_radius) {
  LightRow row{"sun", 0, {}};
  const double one_minus_cos = 1.0 - double{light.cos_total};
  const double solid_angle = 2 * std::numbers::pi * one_minus_cos;
  const Vec3d z = to_double(light.direction);
  const Vec3d x = normalized(cross(std::fabs(z.x) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, z));
  row.parameters.add(light.color);
  row.parameters.add(light.direction);
  row.parameters.add(to_float(x));
  row.parameters.add(to_float(cross(z, x)));
  row.parameters.add(static_cast<float>(one_minus_cos));
  row.parameters.add(static_cast<float>(one_minus_cos * (2 - one_minus_cos)));
  row.parameters.add(static_cast<float>(1 / solid_angle));
  row.weight =
      luminance(light.color) * solid_angle * std::numbers::pi * scene_radius * scene_radius;
  return row;
}

LightRow point_row(const Light& light) {
  LightRow row{"point", 4 * std::numbers::pi * luminance(light.color), {}};
  row.parameters.add(light.color);
  row.parameters.add(light.position);
  return row;
}

LightRow spot_row(const Light& light) {
  LightRow row = point_row(light);
  row.kind = "spot";
  row.parameters.add(light.direction);
  row.parameters.add(light.cos_total);
  // Equal angles make a sharp edge: one ulp apart, so that the ramp has a width.
  row.parameters.add(std::max(light.cos_falloff, std::nextafter(light.cos_total, 2.0f)));
  row.weight *= 0.5 * (1.0 - 0.5 * (double{light.cos_total} + double{light.cos_falloff}));
  return row;
}

LightRow constant_row(const Light& light) {
  LightRow row{"constant_infinite", 0, {}};
  row.parameters.add(light.color);
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
  switch (light.kind) {
    case LightKind::point:
      return point_row(light);
    case LightKind::spot:
      return spot_row(light);
    case LightKind::sun:
      return sun_row(light, radius);
    case LightKind::constant_infinite:
      return constant_row(light);
    case LightKind::infinite:
      return infinite_row(scene, light, radius, cache, tables);
  }
  DS_ASSERT(false);
}

bool is_escape(const Features& features, const LightRow& row) {
  return Features::number(features.escape_lights, row.kind) >= 0;
}

}  // namespace

void pack_lights(const Scene& scene, const Features& features, PackCache* cache,
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
                        [&](const LightRow& row) { return !is_escape(features, row); });

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
    if (is_escape(features, row))
      packed.data.first_escape_light = std::min(packed.data.first_escape_light, i);
    packed.lights.add(static_cast<std::uint32_t>(Features::number(features.lights, row.kind)));
    packed.lights.add(static_cast<float>(shares[i]));
    for (const std::uint32_t word : row.parameters.words())
      packed.lights.add(word);
    packed.lights.pad_to((i + 1) * std::size_t{kernels::k_light_words});
  }
}

}  // namespace ds

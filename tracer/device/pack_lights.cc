// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/device/scene_pack.h"
#include "tracer/kernels/all_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ds {
namespace {

constexpr double k_pi = 3.14159265358979323846;

double luminance(Vec3 c) {
  return 0.2126 * double{c.x} + 0.7152 * double{c.y} + 0.0722 * double{c.z};
}

/// One light's row in the making.
struct Row {
  std::string_view kind;
  double weight = 0;  ///< share of next-event estimation before normalising; 0: never sampled
  Words parameters;
};

/// Cumulative shares as floats; the last of positive share and all behind it are exactly 1.
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

/// sin of the polar angle at row y of an image of this height, by the kernels' own polynomial: the
/// same on every machine.
double polar_sine(double y, int height) {
  return double{kernels::sin_cos_turns(static_cast<float>(y / (2.0 * height))).sin};
}

/// Luminance of a texel.
double texel_luminance(const Image& image, int column, int row) {
  const std::size_t at =
      3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(column));
  return luminance({image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]});
}

/// Weights of the cells of lights/infinite.h, row by row; `heights[r]` in texels.
struct Cells {
  std::vector<double> weights;
  std::vector<double> heights;
  double total = 0;
};

Cells cells_of(const Image& image) {
  Cells cells;
  const int w = image.width;
  const int h = image.height;
  for (int row = 0; row <= h; ++row) {
    const int above = std::max(row - 1, 0);
    const int below = std::min(row, h - 1);
    const double low = std::max(row - 0.5, 0.0);
    const double high = std::min(row + 0.5, double(h));
    cells.heights.push_back(high - low);
    const double sine = polar_sine(0.5 * (low + high), h);
    for (int column = 0; column < w; ++column) {
      const int left = column == 0 ? w - 1 : column - 1;
      const double mean =
          0.25 * (texel_luminance(image, left, above) + texel_luminance(image, column, above) +
                  texel_luminance(image, left, below) + texel_luminance(image, column, below));
      cells.weights.push_back(mean * sine * (high - low));
      cells.total += cells.weights.back();
    }
  }
  return cells;
}

/// Where an image's texels stand in tables: all images come first, one behind the other
/// (scene_pack.cc).
std::uint32_t texel_offset(const Scene& scene, int image) {
  std::size_t offset = 0;
  for (int i = 0; i < image; ++i)
    offset += scene.images[static_cast<std::size_t>(i)].rgb.size();
  return static_cast<std::uint32_t>(offset);
}

Row infinite_row(const Scene& scene, const Light& light, double scene_radius, Words& tables) {
  const Image& image = scene.images[static_cast<std::size_t>(light.image)];
  const Cells cells = cells_of(image);
  const auto w = static_cast<std::size_t>(image.width);
  const auto h = static_cast<std::size_t>(image.height);
  std::vector<double> rows;
  for (std::size_t r = 0; r <= h; ++r)
    rows.push_back(std::accumulate(cells.weights.begin() + static_cast<std::ptrdiff_t>(r * w),
                                   cells.weights.begin() + static_cast<std::ptrdiff_t>((r + 1) * w),
                                   0.0));
  Row result{"infinite", 0, {}};
  Words& p = result.parameters;
  p.add(static_cast<std::uint32_t>(image.width));
  p.add(static_cast<std::uint32_t>(image.height));
  // The light's factor is applied to a copy of the texels, so that one image may serve a texture as
  // well.
  const bool plain = light.color == Vec3{1, 1, 1};
  const std::uint32_t own_texels = plain ? texel_offset(scene, light.image) : tables.offset();
  if (!plain)
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      tables.add(image.rgb[i] * light.color[static_cast<int>(i % 3)]);
  p.add(own_texels);
  p.add(tables.offset());
  add_cumulative(rows, tables);
  constexpr std::size_t block = kernels::k_column_block;
  const std::size_t blocks = (w + block - 1) / block;
  const std::uint32_t columns = tables.offset();
  p.add(columns);
  for (std::size_t r = 0; r <= h; ++r) {
    std::vector<double> row(cells.weights.begin() + static_cast<std::ptrdiff_t>(r * w),
                            cells.weights.begin() + static_cast<std::ptrdiff_t>((r + 1) * w));
    row.resize(blocks * block, 0.0);
    add_cumulative(row, tables);
  }
  p.add(tables.offset());
  const double cell_angle = (2 * k_pi / image.width) * (k_pi / image.height);
  for (std::size_t i = 0; i < cells.weights.size(); ++i)
    tables.add(cells.total > 0 ? static_cast<float>(cells.weights[i] / cells.total /
                                                    (cell_angle * cells.heights[i / w]))
                               : 0.0f);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      p.add(static_cast<float>(light.light_to_world.m[column * 4 + row]));
  p.add(tables.offset());
  for (std::size_t i = block - 1; i < (h + 1) * blocks * block; i += block)
    tables.add(std::uint32_t{tables.words()[columns + i]});
  // What falls on a disc of the scene's radius: power, as for the others.
  result.weight =
      cells.total * cell_angle * luminance(light.color) * k_pi * scene_radius * scene_radius;
  return result;
}

Row sun_row(const Light& light, double scene_radius) {
  Row row{"sun", 0, {}};
  const double one_minus_cos = 1.0 - double{light.cos_total};
  const double solid_angle = 2 * k_pi * one_minus_cos;
  const Vec3d z = to_double(light.direction);
  const Vec3d x = normalized(cross(std::fabs(z.x) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, z));
  row.parameters.add(light.color);
  row.parameters.add(light.direction);
  row.parameters.add(to_float(x));
  row.parameters.add(to_float(cross(z, x)));
  row.parameters.add(static_cast<float>(one_minus_cos));
  row.parameters.add(static_cast<float>(one_minus_cos * (2 - one_minus_cos)));
  row.parameters.add(static_cast<float>(1 / solid_angle));
  row.weight = luminance(light.color) * solid_angle * k_pi * scene_radius * scene_radius;
  return row;
}

Row point_row(const Light& light) {
  Row row{"point", 4 * k_pi * luminance(light.color), {}};
  row.parameters.add(light.color);
  row.parameters.add(light.position);
  return row;
}

Row spot_row(const Light& light) {
  Row row = point_row(light);
  row.kind = "spot";
  row.parameters.add(light.direction);
  row.parameters.add(light.cos_total);
  // Equal angles make a sharp edge: one ulp apart, so that the ramp has a width.
  row.parameters.add(std::max(light.cos_falloff, std::nextafter(light.cos_total, 2.0f)));
  row.weight *= 0.5 * (1.0 - 0.5 * (double{light.cos_total} + double{light.cos_falloff}));
  return row;
}

Row constant_row(const Light& light) {
  Row row{"constant_infinite", 0, {}};
  row.parameters.add(light.color);
  return row;
}

Row mesh_row(const Scene& scene, const Object& object, std::uint32_t first_triangle,
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
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  Row row{"mesh", luminance(material.emission.constant) * area * k_pi, {}};
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

Row light_row(const Scene& scene, const Light& light, double radius, Words& tables) {
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
      return infinite_row(scene, light, radius, tables);
  }
  DS_ASSERT(false);
}

bool is_escape(const Features& features, const Row& row) {
  return Features::number(features.escape_lights, row.kind) >= 0;
}

}  // namespace

void pack_lights(const Scene& scene, const Features& features, PackedScene& packed,
                 std::vector<std::uint32_t>& mesh_lights) {
  const double radius = scene_radius_of(scene);
  const std::vector<std::uint32_t> first = first_triangles(scene);
  std::vector<Row> rows;
  mesh_lights.assign(scene.objects.size(), k_none);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.material < 0 || !scene.materials[static_cast<std::size_t>(object.material)].emits)
      continue;
    mesh_lights[i] = static_cast<std::uint32_t>(rows.size());
    rows.push_back(mesh_row(scene, object, first[i], packed.tables));
  }
  for (const Light& light : scene.lights)
    rows.push_back(light_row(scene, light, radius, packed.tables));
  std::stable_partition(rows.begin(), rows.end(),
                        [&](const Row& row) { return !is_escape(features, row); });

  // Power says little about what reaches a point: mixed half and half with equal shares, no light
  // is starved.
  double total = 0;
  std::size_t sampled = 0;
  for (const Row& row : rows) {
    total += row.weight;
    sampled += row.weight > 0 ? 1 : 0;
  }
  std::vector<double> shares;
  for (const Row& row : rows)
    shares.push_back(row.weight > 0 ? 0.5 * row.weight / total + 0.5 / double(sampled) : 0.0);

  packed.data.light_count = static_cast<std::uint32_t>(rows.size());
  packed.data.first_escape_light = packed.data.light_count;
  packed.data.light_table = packed.tables.offset();
  add_cumulative(shares, packed.tables);
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
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

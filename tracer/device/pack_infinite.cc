// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/canonical.h"
#include "tracer/base/luminance.h"
#include "tracer/device/pack_rows.h"
#include "tracer/kernels/all_nodes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>

namespace ds {
namespace {

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
  return luminance(Vec3{image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]});
}

/// Weights of the cells of lights/infinite.h, row by row, and the sine that stands for each row.
struct Cells {
  std::vector<double> weights;
  std::vector<double> sines;
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
    cells.sines.push_back(polar_sine(0.5 * (low + high), h));
    for (int column = 0; column < w; ++column) {
      const int left = column == 0 ? w - 1 : column - 1;
      const double mean =
          0.25 * (texel_luminance(image, left, above) + texel_luminance(image, column, above) +
                  texel_luminance(image, left, below) + texel_luminance(image, column, below));
      cells.weights.push_back(mean * cells.sines.back() * (high - low));
      cells.total += cells.weights.back();
    }
  }
  return cells;
}

/// The texel in one word (infinite_shared_exponent), where it fits exactly.
std::optional<std::uint32_t> shared_exponent_word(const float* rgb) {
  const float greatest = std::max({rgb[0], rgb[1], rgb[2]});
  if (greatest == 0 && rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) return 0u;
  if (!(greatest > 0) || !std::isfinite(greatest)) return std::nullopt;
  const int exponent = std::ilogb(greatest) - 7;  // the greatest is 128 to 255 of its steps
  if (exponent + 127 < 1) return std::nullopt;
  std::uint32_t word = static_cast<std::uint32_t>(exponent + 127) << 24;
  for (unsigned c = 0; c < 3; ++c) {
    const float steps = std::ldexp(rgb[c], -exponent);
    if (!(steps >= 0 && steps <= 255 && steps == std::floor(steps))) return std::nullopt;
    word |= static_cast<std::uint32_t>(steps) << (8 * c);
  }
  return word;
}

/// The image's texels as words; nothing where one does not fit.
std::vector<std::uint32_t> shared_exponents(const Image& image) {
  std::vector<std::uint32_t> words;
  words.reserve(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    const std::optional<std::uint32_t> word = shared_exponent_word(&image.rgb[i]);
    if (!word) return {};
    words.push_back(*word);
  }
  return words;
}

InfiniteTables tables_of(const Image& image) {
  InfiniteTables result;
  Words words;
  for (const std::uint32_t word : shared_exponents(image))
    words.add(word);
  result.has_texels = words.offset() > 0;
  const Cells cells = cells_of(image);
  const auto w = static_cast<std::size_t>(image.width);
  const auto h = static_cast<std::size_t>(image.height);
  const auto row_weights = [&](std::size_t r) {
    const auto begin = cells.weights.begin() + static_cast<std::ptrdiff_t>(r * w);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(w));
  };
  result.rows = words.offset();
  std::vector<double> rows;
  for (std::size_t r = 0; r <= h; ++r) {
    const std::vector<double> row = row_weights(r);
    rows.push_back(std::accumulate(row.begin(), row.end(), 0.0));
  }
  add_cumulative(rows, words);
  const double cell_angle =
      (2 * std::numbers::pi / image.width) * (std::numbers::pi / image.height);
  result.weight = cells.total * cell_angle;
  result.sines = words.offset();
  for (const double sine : cells.sines)
    words.add(cells.total > 0 ? static_cast<float>(sine / (cells.total * cell_angle)) : 0.0f);
  constexpr std::size_t block = kernels::k_column_block;
  const std::size_t blocks = (w + block - 1) / block;
  result.columns = words.offset();
  for (std::size_t r = 0; r <= h; ++r) {
    std::vector<double> row = row_weights(r);
    row.resize(blocks * block, 0.0);
    add_cumulative(row, words);
  }
  result.blocks = words.offset();
  for (std::size_t i = block - 1; i < (h + 1) * blocks * block; i += block)
    words.add(std::uint32_t{words.words()[result.columns + i]});
  result.words = words.words();
  return result;
}

Hash128 hash_of(const Image& image) {
  CanonicalText use;
  use.add("width", image.width);
  use.add("pixels", hash_bytes(std::as_bytes(std::span(image.rgb))).hex());
  return hash_text(use.text());
}

}  // namespace

/// Texels that a shared exponent of 8 bits and mantissas of 8 bits hold exactly, as those of .hdr
/// files are, are kept in one word each.
LightRow pack_infinite(const Scene& scene, const Light& light, double scene_radius,
                       PackCache* cache, Words& tables) {
  const Image& image = scene.images[static_cast<std::size_t>(light.image)];
  const auto make = [&] { return tables_of(image); };
  const auto known = cache != nullptr ? cache->infinite.get(hash_of(image), make)
                                      : std::make_shared<const InfiniteTables>(make());
  const std::uint32_t base = tables.offset();
  tables.add(std::span(known->words));
  const std::uint32_t texels = known->has_texels ? base : tables.offset();
  if (!known->has_texels) tables.add(std::span(image.rgb));
  LightRow result{"infinite", 0, {}};
  Words& p = result.parameters;
  p.add(static_cast<std::uint32_t>(image.width));
  p.add(static_cast<std::uint32_t>(image.height));
  p.add(texels);
  p.add(known->has_texels ? std::uint32_t{1} : std::uint32_t{0});
  p.add(light.color);
  p.add(base + known->rows);
  p.add(base + known->sines);
  p.add(base + known->columns);
  p.add(base + known->blocks);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      p.add(static_cast<float>(light.light_to_world.m[column * 4 + row]));
  // What falls on a disc of the scene's radius: power, as for the others.
  result.weight =
      known->weight * luminance(light.color) * std::numbers::pi * scene_radius * scene_radius;
  return result;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/pixel_counts.h"

#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

/// Of 255: what is not above is black to people, on any screen, and a tone map's rounding.
constexpr std::uint8_t k_black = 4;

struct Field {
  const char* name;
  std::optional<std::uint64_t> PixelCounts::*count;
};
constexpr Field k_fields[] = {{"lit", &PixelCounts::lit},       {"white", &PixelCounts::white},
                              {"model", &PixelCounts::model},   {"frame", &PixelCounts::frame},
                              {"amodal", &PixelCounts::amodal}, {"left", &PixelCounts::left},
                              {"right", &PixelCounts::right},   {"above", &PixelCounts::above},
                              {"below", &PixelCounts::below},   {"beyond", &PixelCounts::beyond},
                              {"whole", &PixelCounts::whole}};

struct ObjectField {
  const char* name;
  std::uint64_t ObjectCounts::*count;
};
constexpr ObjectField k_object_fields[] = {
    {"seen", &ObjectCounts::seen},   {"amodal", &ObjectCounts::amodal},
    {"frame", &ObjectCounts::frame}, {"left", &ObjectCounts::left},
    {"right", &ObjectCounts::right}, {"above", &ObjectCounts::above},
    {"below", &ObjectCounts::below}};

std::uint64_t count_from(const json& object, const char* name) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_number_unsigned())
    fail(ErrorKind::asset, "{} must be a count, got {}", name,
         at == object.end() ? "none" : at->dump(-1, ' ', false, json::error_handler_t::replace));
  return at->get<std::uint64_t>();
}

}  // namespace

PixelCounts count_picture(std::span<const std::uint8_t> samples, int channels) {
  std::uint64_t lit = 0;
  const auto step = static_cast<std::size_t>(channels);
  for (std::size_t at = 0; at + step <= samples.size(); at += step) {
    const auto pixel = samples.subspan(at, step);
    lit += *std::max_element(pixel.begin(), pixel.end()) > k_black ? 1U : 0U;
  }
  return {lit, {}, {}, {}};
}

PixelCounts count_mask(std::span<const std::uint8_t> samples, int width, int height) {
  DS_ASSERT(samples.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::uint64_t model = 0, frame = 0;
  int left = width, right = width, above = height, below = height;
  std::size_t at = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++at) {
      if (samples[at] == 0) continue;
      ++model;
      frame += x == 0 || y == 0 || x == width - 1 || y == height - 1 ? 1U : 0U;
      left = std::min(left, x);
      right = std::min(right, width - 1 - x);
      above = std::min(above, y);
      below = height - 1 - y;
    }
  }
  PixelCounts counts{{}, {}, model, frame};
  const auto count = [](int pixels) { return static_cast<std::uint64_t>(pixels); };
  counts.left = count(left);
  counts.right = count(right);
  counts.above = count(above);
  counts.below = count(below);
  return counts;
}

PixelCounts count_amodal_mask(std::span<const std::uint8_t> samples, int width, int height) {
  return {{}, {}, {}, {}, count_mask(samples, width, height).model};
}

ObjectCounts count_object(std::uint32_t id, std::span<const float> ids,
                          std::span<const float> amodal, int width, int height) {
  std::vector<std::uint8_t> mask(ids.size());
  std::transform(ids.begin(), ids.end(), mask.begin(), [&](float pixel) {
    return std::bit_cast<std::uint32_t>(pixel) == id ? std::uint8_t{255} : std::uint8_t{0};
  });
  const PixelCounts seen = count_mask(mask, width, height);
  ObjectCounts counts;
  counts.id = id;
  counts.seen = *seen.model;
  counts.frame = *seen.frame;
  counts.left = *seen.left;
  counts.right = *seen.right;
  counts.above = *seen.above;
  counts.below = *seen.below;
  counts.amodal = static_cast<std::uint64_t>(
      std::count_if(amodal.begin(), amodal.end(), [](float covered) { return covered > 0; }));
  return counts;
}

void add_counts(PixelCounts& to, const PixelCounts& from) {
  for (const Field& field : k_fields)
    if (!(to.*field.count)) to.*field.count = from.*field.count;
  if (to.objects.empty()) to.objects = from.objects;
}

json to_json_value(const PixelCounts& counts) {
  json object = json::object();
  for (const Field& field : k_fields)
    if (counts.*field.count) object[field.name] = *(counts.*field.count);
  for (const ObjectCounts& one : counts.objects) {
    json value = to_json_value(one);
    value["id"] = one.id;
    object["objects"].push_back(std::move(value));
  }
  return object;
}

json to_json_value(const ObjectCounts& counts) {
  json object = json::object();
  for (const ObjectField& field : k_object_fields)
    object[field.name] = counts.*field.count;
  return object;
}

ObjectCounts object_counts_from(const json& object, std::uint32_t id) {
  if (!object.is_object())
    fail(ErrorKind::asset, "an object's counts must be an object, got {}", object.type_name());
  ObjectCounts counts;
  counts.id = id;
  for (const ObjectField& field : k_object_fields)
    counts.*field.count = count_from(object, field.name);
  return counts;
}

PixelCounts pixel_counts_from(const json& object) {
  if (!object.is_object())
    fail(ErrorKind::asset, "pixel_counts must be an object, got {}", object.type_name());
  PixelCounts counts;
  for (const Field& field : k_fields) {
    const auto at = object.find(field.name);
    if (at == object.end()) continue;
    if (!at->is_number_unsigned())
      fail(ErrorKind::asset, "pixel_counts.{} must be a count, got {}", field.name,
           at->dump(-1, ' ', false, json::error_handler_t::replace));
    counts.*field.count = at->get<std::uint64_t>();
  }
  if (const auto list = object.find("objects"); list != object.end()) {
    if (!list->is_array()) fail(ErrorKind::asset, "pixel_counts.objects must be a list");
    for (const json& one : *list)
      counts.objects.push_back(
          object_counts_from(one, static_cast<std::uint32_t>(count_from(one, "id"))));
  }
  return counts;
}

}  // namespace ds

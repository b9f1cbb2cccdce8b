// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ds {

/// What an image shows of a thing beside the model, in pixels.
struct ObjectCounts {
  std::uint32_t id = 0;      ///< in the plane object_id
  std::uint64_t seen = 0;    ///< shows it
  std::uint64_t amodal = 0;  ///< would if nothing else were there
  std::uint64_t frame = 0;   ///< of `seen`, in the first or last row or column
  /// As those of PixelCounts.
  std::uint64_t left = 0, right = 0, above = 0, below = 0;

  bool operator==(const ObjectCounts&) const = default;
};

/// What of an image's picture and mask tells that they are of no use, in pixels. Counts that nobody
/// made are absent: of an image without a mask, or in the records of an older dsbuild.
struct PixelCounts {
  std::optional<std::uint64_t> lit;  ///< of the picture: some channel is above 4 of 255
  /// Of the picture: clipped in every channel (clipped_pixels).
  std::optional<std::uint64_t> white;
  std::optional<std::uint64_t> model;     ///< of the mask: the model is seen
  std::optional<std::uint64_t> frame;     ///< of those, in the first or last row or column
  std::optional<std::uint64_t> amodal{};  ///< of the amodal mask: what would be seen of it alone
  /// Of the mask: columns before and behind the model, rows above and below it; all where it is not
  /// seen. They tell the box around it.
  std::optional<std::uint64_t> left{}, right{}, above{}, below{};
  std::optional<std::uint64_t> beyond{}, whole{};  ///< as count_beyond gives them
  std::vector<ObjectCounts> objects{};             ///< by id; empty where nobody counted them, too

  bool operator==(const PixelCounts&) const = default;
};

/// `lit` of 8 bit samples, interleaved. Whether a white pixel is clipped they do not tell.
PixelCounts count_picture(std::span<const std::uint8_t> samples, int channels);
/// `model`, `frame` and the sides of a mask, one sample a pixel, 0 where the model is not seen.
PixelCounts count_mask(std::span<const std::uint8_t> samples, int width, int height);
/// `amodal` of an amodal mask, likewise.
PixelCounts count_amodal_mask(std::span<const std::uint8_t> samples, int width, int height);
/// Of the samples of object_id, and of the amodal mask of that object.
ObjectCounts count_object(std::uint32_t id, std::span<const float> ids,
                          std::span<const float> amodal, int width, int height);
/// Those of `to` that are absent, taken from the other.
void add_counts(PixelCounts& to, const PixelCounts& from);

/// An object of the counts that are there, by name; "objects": a list.
nlohmann::json to_json_value(const PixelCounts& counts);
/// All but the id.
nlohmann::json to_json_value(const ObjectCounts& counts);
/// Throws Error(asset) with the field's name for what is no such object. The id is `id`.
ObjectCounts object_counts_from(const nlohmann::json& object, std::uint32_t id);
/// Throws Error(asset) with the field's name for what is no count.
PixelCounts pixel_counts_from(const nlohmann::json& object);

}  // namespace ds

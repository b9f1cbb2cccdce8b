// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/film.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// A film under way as bytes, so that tracing goes on from it in another run:
///
///   file     = head tiles planes checksum
///   head     = "dsbuild film 2\n" { name "=" value "\n" } "\n"
///   tiles    = { u32 }       samples a pixel of each tile of 4x4 pixels, row by row
///   planes   = { float32 }   each plane that "planes" lists: 16 values a tile
///   checksum = XXH3-128 of all before it, 16 bytes, most significant first
///
/// Numbers are little-endian. Names, in this order and each once:
///   width, height   in pixels
///   planes          which of k_film_* (kernels/film_data.h) follow, space between; the rest, and no
///                   others, are zero all over; one at least, as every sample is counted
///   tone_scale      of ScheduleState, a hexadecimal float, or "none"
///   least_bound     of ScheduleState, a hexadecimal float or "inf"
///
/// Every film has one spelling. 176 bytes a pixel where no sample was out of the ordinary. Version
/// history: 1, the first; 2, quarters of pixels. Another version is refused, and its picture traced
/// from the start.
///
/// The film has samples.
std::vector<std::byte> encode_film_sums(const FilmSums& film);
/// Throws Error(asset) for bytes that `encode_film_sums` would not write. `name` stands in
/// messages. Takes memory in proportion to the bytes, whatever their head says.
FilmSums decode_film_sums(std::span<const std::byte> bytes, const std::string& name);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/plane_types.h"
#include "tracer/render/develop.h"
#include "tracer/render/render.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// How a plane's numbers stand in its file. What PNG makes of them the plane's traits say
/// (tracer/kernels/plane_traits.h): a share of the whole range, thousandths, or the number itself;
/// where nothing was met it holds 0. EXR has the channel Y, or R, G, B in the numbers' order; of two
/// numbers B is 0.
enum class PlaneEncoding { png8, png16, half, exr, rgba8 };

/// "png8", "png16", "half", "exr", "rgba8".
std::string_view name_of(PlaneEncoding encoding);
/// Those a plane can have, the usual one first.
std::vector<PlaneEncoding> encodings_of(const PlaneType& type);
/// ".png", ".exr".
std::string_view ending_of(PlaneEncoding encoding);
/// Stands in the keys: a change of an encoder's settings changes it and makes the files anew.
std::string_view format_of(PlaneEncoding encoding);

/// The largest id that the encoding holds, of planes of ids.
std::uint32_t largest_id(PlaneEncoding encoding);

/// Throws Error(recipe) for an id that the encoding cannot hold. Not for rgba8: see cut_out.
std::vector<std::byte> encode_plane(const Plane& plane, PlaneEncoding encoding);

/// The picture on a transparent background, of the planes foreground and alpha: foreground / alpha, 0 where
/// alpha is, developed at `scale` (tone_map_scale of the whole film); straight alpha, rounded like the rest.
BytePicture cut_out(const Plane& foreground, const Plane& alpha, const ToneMap& tone_map,
                    double scale);

}  // namespace ds

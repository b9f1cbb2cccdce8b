// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"
#include "tracer/scene/type_tables.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The least and the greatest value that an input takes in each of its channels.
using InputBounds = DS_KERNELS::ValueBounds;

/// Of an image's pixels, linear and with its gain; nothing where they cannot be told.
using BoundsOfImage = std::function<std::optional<InputBounds>(const Image&)>;

/// Of a constant, or of a texture whose constants and images tell it; they are `reached`. Nothing of noise,
/// and where two textures meet whose extremes may lie in different places. A mesh's colours reach from
/// 0 to 1.
std::optional<InputBounds> input_bounds(const Scene& scene, const TextureRef& ref,
                                        const BoundsOfImage& image);

/// What an image's file name and gain tell: 8 and 16 bits reach from 0 to 1. Else all that may be.
std::optional<InputBounds> bounds_before_reading(const Image& image);
/// What bilinear interpolation and the wrap mode make of the loaded pixels.
InputBounds bounds_of_pixels(const Image& image);

/// "SUBJECT: wanted numbers in [0, 1], found 255 0 0: ..." where the bounds are none that the
/// input's header calls physical; nothing else.
std::optional<std::string> say_unphysical(std::string_view subject, const Parameter& input,
                                          const InputBounds& bounds, bool is_texture);

/// Appends to each material's `unphysical` what its images' pixels tell, and gives what was added.
std::vector<std::string> add_unphysical_of_pixels(Scene& scene, const BoundsOfImage& image);

}  // namespace ds

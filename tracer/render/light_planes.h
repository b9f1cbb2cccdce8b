// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/device/plane_types.h"
#include "tracer/render/film.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/render.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ds {

/// Words of the film of so many planes of light beside a picture's (kernels/light_film_data.h).
std::size_t light_film_words(const FilmSums& picture, std::size_t planes);

/// The planes' pixels, through the filter that the picture's samples go through: the light that
/// `words` hold over the samples that the picture counted.
std::vector<Plane> light_planes_of(const std::vector<const PlaneType*>& types,
                                   std::span<const float> words, FilmSums picture,
                                   const PixelFilter& filter);

}  // namespace ds

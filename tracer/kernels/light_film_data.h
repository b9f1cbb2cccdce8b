// SPDX-License-Identifier: Apache-2.0
// The film of planes of light beside a picture, as word offsets that host and device share: tiles as
// the picture's film has them, of k_light_plane rows for each plane, one float for each pixel. Counts
// of samples are in the picture's film.
#pragma once

#include "tracer/kernels/language.h"

/// Of each quarter of a pixel: r, g, b, and what rounding has cut off of them.
enum { k_light_sum = 0, k_light_compensation = 3, k_light_quarter = 6 };
enum { k_light_plane = 4 * k_light_quarter };

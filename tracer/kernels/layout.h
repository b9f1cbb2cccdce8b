// SPDX-License-Identifier: Apache-2.0
// What host and device share as C++, in namespace ds::kernels.
#pragma once

#include "tracer/kernels/host.h"

namespace ds::DS_KERNELS {
#include "tracer/kernels/film_data.h"
#include "tracer/kernels/guide_data.h"
#include "tracer/kernels/light_film_data.h"
#include "tracer/kernels/plane_traits.h"
#include "tracer/kernels/ray_counts_data.h"
#include "tracer/kernels/scene_data.h"
#include "tracer/kernels/traits.h"
#include "tracer/kernels/view_data.h"
}  // namespace ds::DS_KERNELS

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/photons.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// Where as many photons or more are started the cube has 64 cells along a side, else 32.
inline constexpr std::size_t k_photons_of_fine_cells = std::size_t{1} << 14;

/// The table of tracer/kernels/guide.h for these photons, of `started` that were sent: cells of a
/// cube of 8 radii around `centre`, each with up to k_guide_lobes spheres around where the photons in
/// it and next to it came from. The same bits on every machine.
std::vector<std::uint32_t> guide_table(std::span<const Photon> photons, std::size_t started,
                                       Vec3 centre, float radius);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/photons.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ds {

/// The table of tracer/kernels/guide.h for these photons: cells of a cube of 8 radii around
/// `centre`, each with up to k_guide_lobes spheres around where the photons in it and next to it
/// came from. The same bits on every machine.
std::vector<std::uint32_t> guide_table(std::span<const Photon> photons, Vec3 centre, float radius);

}  // namespace ds

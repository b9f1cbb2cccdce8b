// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/fresnel_presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace ds {
namespace {

struct Preset {
  std::string_view name;
  ConductorIndex index;
};

// Means of the measured n and k over the bands that `spectrum_to_rgb` weighs with, each over that
// of the spectrum 1, 380 to 780 nm; the data are those of refractiveindex.info (public domain,
// CC0): aluminium: McPeak et al., ACS Photonics 2 (2015); amorphous carbon: Arakawa et al., J.
// Appl. Phys. 48 (1977); copper, silver: Johnson and Christy, Phys. Rev. B 6 (1972); gold:
// Yakubovsky et al., Opt. Express 25 (2017), 117 nm.
constexpr Preset k_presets[] = {
    {"aluminium", {{1.146f, 0.769f, 0.450f}, {6.710f, 5.796f, 4.643f}}},
    {"amorphous carbon", {{2.443f, 2.349f, 2.164f}, {0.737f, 0.842f, 0.897f}}},
    {"copper", {{0.237f, 1.037f, 1.298f}, {3.244f, 2.601f, 2.353f}}},
    {"gold", {{0.098f, 0.381f, 1.575f}, {3.625f, 2.393f, 1.787f}}},
    {"silver", {{0.055f, 0.055f, 0.043f}, {4.293f, 3.543f, 2.534f}}},
};

}  // namespace

const ConductorIndex* find_conductor_preset(std::string_view name) {
  const auto found = std::find_if(std::begin(k_presets), std::end(k_presets),
                                  [&](const Preset& preset) { return preset.name == name; });
  return found == std::end(k_presets) ? nullptr : &found->index;
}

std::vector<std::string_view> conductor_preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : k_presets)
    names.push_back(preset.name);
  return names;
}

}  // namespace ds

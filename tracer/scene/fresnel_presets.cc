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

constexpr Preset k_presets[] = {
    {"aluminium", {{1.36f, 0.965f, 0.618f}, {7.57f, 6.40f, 5.30f}}},
    {"amorphous carbon", {{2.3f, 2.25f, 2.2f}, {0.8f, 0.8f, 0.8f}}},
    {"copper", {{0.214f, 1.13f, 1.16f}, {3.67f, 2.59f, 2.46f}}},
    {"gold", {{0.18f, 0.51f, 1.37f}, {3.07f, 2.22f, 1.87f}}},
    {"silver", {{0.059f, 0.054f, 0.047f}, {4.28f, 3.43f, 2.81f}}},
};

}  // namespace

const ConductorIndex* find_conductor_preset(std::string_view name) {
  const auto found = std::find_if(std::begin(k_presets), std::end(k_presets),
                                  [&](const Preset& preset) { return preset.name == name; });
  return found == std::end(k_presets) ? nullptr : &found->index;
}

std::string conductor_preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : k_presets)
    names.push_back(preset.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/alike.h"

#include <optional>
#include <tuple>

namespace ds {
namespace {

// Every member, and so no fewer: a struct with one more does not compile.
auto members(const Camera& camera) {
  const auto& [type, position, target, up, fov_deg, extent_m, lens_radius_m, focus_distance_m] =
      camera;
  return std::tie(type, position, target, up, fov_deg, extent_m, lens_radius_m, focus_distance_m);
}
auto members(const ToneMap& map) {
  const auto& [kind, scale, prescale, postscale, burn, gamma] = map;
  return std::tie(kind, scale, prescale, postscale, burn, gamma);
}
bool same_target(const std::optional<ErrorTarget>& a, const std::optional<ErrorTarget>& b) {
  if (!a || !b) return !a && !b;
  const auto& [a_error, a_max_spp, a_tone_map, a_region] = *a;
  const auto& [b_error, b_max_spp, b_tone_map, b_region] = *b;
  return std::tie(a_error, a_max_spp, a_region) == std::tie(b_error, b_max_spp, b_region) &&
         members(a_tone_map) == members(b_tone_map);
}
/// All but seed and target.
auto members(const EngineSettings& engine) {
  const auto& [width, height, spp, target, depth_total, depth_diffuse, depth_glossy, depth_specular,
               roulette_depth, roulette_cap, filter_width, seed, outlier_limit, math] = engine;
  return std::tie(width, height, spp, depth_total, depth_diffuse, depth_glossy, depth_specular,
                  roulette_depth, roulette_cap, filter_width, outlier_limit, math);
}

}  // namespace

bool same(const Camera& a, const Camera& b) {
  return members(a) == members(b);
}
bool same_but_seed(const EngineSettings& a, const EngineSettings& b) {
  return members(a) == members(b) && same_target(a.target, b.target);
}

}  // namespace ds

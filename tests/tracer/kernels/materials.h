// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/type_tables.h"

#include <ostream>
#include <random>
#include <string_view>
#include <vector>

/// The materials of kernels/lists.h as C++ functions, one lane wide.
namespace ds::materials {

struct Case {
  std::string_view name;
  kernels::BsdfValue (*evaluate)(const float* p, kernels::Viewer viewer, kernels::real3 wi);
  kernels::BsdfSample (*sample)(const float* p, kernels::Viewer viewer, kernels::real2 u,
                                kernels::real2 lobe);
  kernels::real3 (*diffuse)(const float* p, kernels::Viewer viewer, kernels::real3 wi);
  /// For the viewer along the normal.
  kernels::real3 (*albedo)(const float* p, kernels::Viewer viewer);
  const NodeType* type;
};
/// How GoogleTest prints one.
inline void PrintTo(const Case& material, std::ostream* out) {
  *out << material.name;
}

/// Mix is one of metal2 with a mix of matte and mirror (mix_on_host.h): its value and pdf are means
/// over its parts, a sample's weight and pdf are those of the part it chose.
std::vector<Case> all();

/// What pictures::seen_value has, in the layout the functions take, with every roughness so that a lobe's alpha is this.
std::vector<float> inputs(const Case& material, float alpha);
/// All that are shares of light at 1 besides.
std::vector<float> white_inputs(const Case& material, float alpha);
/// What those inputs are that are shares of light: what a file may say, what is physical, or 1.
enum class Shares { any, physical, all };
/// From the ranges that the header tells, their ends included; 1e6 where there is none.
std::vector<float> random_inputs(const Case& material, std::mt19937& random,
                                 Shares shares = Shares::any);

/// A viewer at this cosine of the angle to the normal and this azimuth, radians.
kernels::Viewer viewer(double cosine, bool outside = true, double azimuth = 0.7);

}  // namespace ds::materials

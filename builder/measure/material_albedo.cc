// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/material_albedo.h"

#include "builder/measure/spread.h"
#include "tracer/base/error.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"
#include "tracer/kernels/prepared.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ds {
namespace {

using kernels::BsdfSample;
using kernels::real2;
using kernels::Viewer;

constexpr int k_samples = 4096;
/// Of six dimensions.
constexpr std::array k_steps{0.8986537126286992, 0.8075784952213447, 0.7257334129697598,
                             0.6521830259439716, 0.5860866975779693, 0.5266889867007358};

using Sampling = BsdfSample (*)(const float*, Viewer, real2, real2);

Sampling sampling_of(int type) {
  using namespace kernels;
#define DS_SAMPLING(sdl_name, prefix, PREFIX)                                \
  [](const float* p, Viewer viewer, real2 u, real2 lobe) {                   \
    return prefix##_sample(DS_PREPARED(prefix, p, viewer), viewer, u, lobe); \
  },
  static constexpr Sampling rows[] = {DS_SCATTERING_MATERIALS(DS_SAMPLING)};
#undef DS_SAMPLING
  return rows[type];
}

std::vector<float> values_of(const Material& material, const NodeType& row) {
  std::vector<float> values;
  for (std::size_t i = 0; i < row.inputs.size(); ++i)
    for (int axis = 0; axis < row.inputs[i].width; ++axis)
      values.push_back(material.inputs[i].constant[axis]);
  values.insert(values.end(), material.numbers.begin(), material.numbers.end());
  return values;
}

}  // namespace

Vec3 material_albedo(const Material& material) {
  const NodeType& row = material_types()[static_cast<std::size_t>(material.type)];
  DS_ASSERT(row.children == 0);
  const std::vector<float> values = values_of(material, row);
  const Sampling sample = sampling_of(material.type);
  Vec3d sum{};
  for (int i = 0; i < k_samples; ++i) {
    const auto numbers = [&](std::size_t dimension) {
      real2 pair;
      pair.x = static_cast<float>(spread(i, k_steps[dimension]));
      pair.y = static_cast<float>(spread(i, k_steps[dimension + 1]));
      return pair;
    };
    Viewer viewer;
    viewer.wo = kernels::cosine_hemisphere(numbers(0));
    viewer.outside = true;
    const BsdfSample s = sample(values.data(), viewer, numbers(2), numbers(4));
    if (!s.valid) continue;
    // A refraction's weight holds the change of radiance with the index, which is no loss.
    const double scale = 1 / double{s.eta_scale};
    sum = sum + scale * Vec3d{double{s.weight.x}, double{s.weight.y}, double{s.weight.z}};
  }
  const auto share = [](double total) {
    return static_cast<float>(std::clamp(total / k_samples, 0.0, 1.0));
  };
  return {share(sum.x), share(sum.y), share(sum.z)};
}

}  // namespace ds

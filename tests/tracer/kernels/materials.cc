// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/kernels/materials.h"

#include "tests/render/pictures.h"
#include "tests/tracer/kernels/mix_on_host.h"
#include "tracer/kernels/lists.h"
#include "tracer/kernels/prepared.h"

#include <algorithm>
#include <cmath>

namespace ds::materials {
namespace {

using namespace kernels;

bool is_roughness(std::string_view name) {
  return name.ends_with("roughness");
}

/// Of a polynomial.
bool is_coefficient(std::string_view name) {
  return name == "p1" || name == "p2" || name == "p3";
}

/// Greatest value an input may sensibly take; the least is 0 but for indices of refraction and coefficients.
float greatest(std::string_view name) {
  if (name == "n" || name == "k" || name == "ka") return 10;
  if (name == "d" || name == "index" || name.ends_with("ior")) return 3;
  if (is_coefficient(name)) return 30;
  return 1;
}
float least(std::string_view name) {
  if (name.ends_with("ior")) return 1;
  if (is_coefficient(name)) return -30;
  return 0;
}

/// Disney's alpha is the square of its roughness.
float roughness_of(const InputType& input, float alpha) {
  return input.name == "roughness" ? std::sqrt(alpha) : alpha;
}

float seen_value(const Case& material, const InputType& input) {
  return pictures::seen_value(*material.type,
                              static_cast<std::size_t>(&input - material.type->inputs.data()));
}

/// Numbers stand behind inputs, at their defaults.
template <typename Value>
std::vector<float> fill(const Case& material, const Value& value) {
  std::vector<float> p;
  for (const InputType& input : material.type->inputs)
    for (int i = 0; i < input.width; ++i)
      p.push_back(value(input));
  for (const NumberType& number : material.type->numbers)
    p.push_back(number.default_value);
  return p;
}

}  // namespace

std::vector<Case> all() {
  std::vector<Case> cases;
#define DS_CASE(sdl_name, prefix, PREFIX)                                                     \
  cases.push_back({sdl_name,                                                                  \
                   [](const float* p, Viewer viewer, real3 wi) {                              \
                     return prefix##_evaluate(DS_PREPARED(prefix, p, viewer), viewer, wi);    \
                   },                                                                         \
                   [](const float* p, Viewer viewer, real2 u, real2 lobe) {                   \
                     return prefix##_sample(DS_PREPARED(prefix, p, viewer), viewer, u, lobe); \
                   },                                                                         \
                   [](const float* p, Viewer viewer, real3 wi) {                              \
                     return prefix##_diffuse(DS_PREPARED(prefix, p, viewer), viewer, wi);     \
                   },                                                                         \
                   [](const float* p, Viewer viewer) {                                        \
                     return prefix##_albedo(DS_PREPARED(prefix, p, viewer), viewer);          \
                   },                                                                         \
                   &material_types()[cases.size()]});
  DS_ALL_MATERIALS(DS_CASE)
#undef DS_CASE
  std::find_if(cases.begin(), cases.end(), [](const Case& c) { return c.name == "mix"; })->type =
      &mix_type();
  return cases;
}

std::vector<float> inputs(const Case& material, float alpha) {
  return fill(material, [&](const InputType& input) {
    return is_roughness(input.name) ? roughness_of(input, alpha) : seen_value(material, input);
  });
}

std::vector<float> white_inputs(const Case& material, float alpha) {
  return fill(material, [&](const InputType& input) {
    if (is_roughness(input.name)) return roughness_of(input, alpha);
    const bool reflectance = input.width == 3 && (limit_of(input.name).physical.most == 1);
    return reflectance ? 1.0f : seen_value(material, input);
  });
}

std::vector<float> random_inputs(const Case& material, std::mt19937& random) {
  std::uniform_real_distribution<float> u(0, 1);
  std::vector<float> p = fill(material, [&](const InputType& input) {
    const float low = least(input.name);
    const float high = greatest(input.name);
    const float choice = u(random);
    if (choice < 0.15f) return low;
    if (choice < 0.3f) return high;
    if (choice < 0.4f && low == 0) return 1e-9f;
    return low + (high - low) * u(random);
  });
  // All of them are switches.
  for (std::size_t i = 0; i < material.type->numbers.size(); ++i)
    p[p.size() - 1 - i] = u(random) < 0.5f ? 0.0f : 1.0f;
  return p;
}

Viewer viewer(double cosine, bool outside, double azimuth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  Viewer v;
  v.wo = vec(static_cast<float>(sine * std::cos(azimuth)),
             static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(cosine));
  v.outside = outside;
  return v;
}

}  // namespace ds::materials

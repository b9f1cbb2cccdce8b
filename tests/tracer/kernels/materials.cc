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

/// What stands for numbers without a bound.
constexpr double k_far = 1e6;

double uniform(std::mt19937& random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}

/// Its ends, its default, and anything between: of a wide range as many near 0 as far from it.
double drawn(const Parameter& told, NumberRange range, float default_value, std::mt19937& random) {
  const double low = std::max(range.least, -k_far), high = std::min(range.most, k_far);
  const double choice = uniform(random), share = uniform(random);
  if (told.kind == ParameterKind::flag) return choice < 0.5 ? 0 : 1;
  double value = low + (high - low) * share;
  if (choice < 0.12)
    value = range.open_least ? low + 1e-6 * (high - low) : low;
  else if (choice < 0.24)
    value = range.open_most ? high - 1e-6 * (high - low) : high;
  else if (choice < 0.3)
    value = double{default_value};
  else if (choice < 0.36)
    value = low + 1e-9 * (high - low);
  else if (high - low > 100 && choice < 0.68)
    value = std::max(low, -10.0) + (std::min(high, 10.0) - std::max(low, -10.0)) * share;
  else if (high - low > 100)
    value = std::clamp(std::pow(10, 9 * share - 3) * (low < 0 && uniform(random) < 0.5 ? -1 : 1),
                       low, high);
  return told.kind == ParameterKind::whole ? std::round(value) : value;
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
    return input.told.kind == ParameterKind::share ? 1.0f : seen_value(material, input);
  });
}

std::vector<float> random_inputs(const Case& material, std::mt19937& random, Shares shares) {
  std::vector<float> p;
  for (const InputType& input : material.type->inputs)
    for (int i = 0; i < input.width; ++i) {
      const bool share = input.told.kind == ParameterKind::share;
      const NumberRange range =
          share && shares != Shares::any ? physical_range(input.told) : input.told.range;
      const double value = drawn(input.told, range, input.default_value, random);
      p.push_back(share && shares == Shares::all ? 1.0f : static_cast<float>(value));
    }
  for (const NumberType& number : material.type->numbers)
    p.push_back(
        static_cast<float>(drawn(number.told, number.told.range, number.default_value, random)));
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

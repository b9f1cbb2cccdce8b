// SPDX-License-Identifier: Apache-2.0
// What tells the class without a look at the model: its material, environment or view. Mutual information
// with the class, in bits, against what chance gives: the values dealt out anew among the models (or the
// images, where a model has several), by hash, so that the answer is the same everywhere.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace ds {
namespace {

using Field = std::string ImageRecord::*;

constexpr int k_deals = 1999;
constexpr Threshold k_shortcuts_p{"shortcuts_p",
                                  0.001,
                                  {.least = 0, .most = 1},
                                  "Chance below which it is no chance that material, environment "
                                  "or view tell the class or split"};
constexpr Threshold k_shortcuts_bits{
    "shortcuts_bits", 0.1, {.least = 0}, "Bits that they may tell of it beyond what chance gives"};

/// Class and value of each model or image, by numbers.
struct Units {
  std::vector<std::uint32_t> classes, values;
  std::uint32_t class_count = 0, value_count = 0;
};

std::uint32_t number_of(std::map<std::string, std::uint32_t>& numbers, const std::string& name) {
  return numbers.try_emplace(name, static_cast<std::uint32_t>(numbers.size())).first->second;
}

/// `target` is what the field may tell: the class, or the split.
Units units_of(const CheckInput& input, Field field, Field target) {
  std::map<std::string, std::optional<std::string>> of_model;  // nothing where a model has several
  for (const ImageRecord& image : input.images) {
    const auto [at, is_new] = of_model.try_emplace(image.model, image.*field);
    if (!is_new && at->second && *at->second != image.*field) at->second.reset();
  }
  const bool by_model = std::all_of(of_model.begin(), of_model.end(),
                                    [](const auto& entry) { return entry.second.has_value(); });
  Units units;
  std::map<std::string, std::uint32_t> classes, values;
  const std::string* last_model = nullptr;
  for (const ImageRecord& image : input.images) {
    const bool again = by_model && last_model != nullptr && *last_model == image.model;
    last_model = &image.model;
    if (again || (image.*target).empty()) continue;
    units.classes.push_back(number_of(classes, image.*target));
    units.values.push_back(number_of(values, image.*field));
  }
  units.class_count = static_cast<std::uint32_t>(classes.size());
  units.value_count = static_cast<std::uint32_t>(values.size());
  return units;
}

double mutual_information(const Units& units, const std::vector<std::uint32_t>& values) {
  const auto n = static_cast<double>(values.size());
  std::vector<double> joint(std::size_t{units.class_count} * units.value_count);
  std::vector<double> of_class(units.class_count), of_value(units.value_count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    joint[std::size_t{units.classes[i]} * units.value_count + values[i]] += 1;
    of_class[units.classes[i]] += 1;
    of_value[values[i]] += 1;
  }
  double bits = 0;
  for (std::size_t c = 0; c < of_class.size(); ++c)
    for (std::size_t v = 0; v < of_value.size(); ++v) {
      const double both = joint[c * units.value_count + v];
      if (both > 0) bits += both / n * std::log2(both * n / (of_class[c] * of_value[v]));
    }
  return bits;
}

/// Fisher and Yates, by hashes of (deal, place).
void deal(std::vector<std::uint32_t>& values, int number) {
  std::uint64_t state = hash64_text(fmt::format("deal {}", number));
  for (std::size_t i = values.size(); i > 1; --i) {
    state += 0x9e3779b97f4a7c15U;  // splitmix64
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    std::swap(values[i - 1], values[(z ^ (z >> 31U)) % i]);
  }
}

/// A field, and what it may tell.
struct Question {
  const char* name;
  Field field;
  const char* target_name;
  Field target;
  const char* danger;
  const char* advice;
};

void check_field(const CheckInput& input, CheckReport& report, const Question& question) {
  const Units units = units_of(input, question.field, question.target);
  if (units.class_count < 2 || units.value_count < 2) return;
  const double bits = mutual_information(units, units.values);
  int as_many = 0;
  double by_chance = 0;
  std::vector<std::uint32_t> values = units.values;
  for (int i = 0; i < k_deals; ++i) {
    deal(values, i);
    const double dealt = mutual_information(units, values);
    by_chance += dealt / k_deals;
    as_many += dealt >= bits * (1 - 1e-12) ? 1 : 0;
  }
  const double p = (1.0 + as_many) / (1.0 + k_deals);
  if (p >= input.threshold(k_shortcuts_p) || bits - by_chance <= input.threshold(k_shortcuts_bits))
    return;
  report.say(CheckLevel::warning,
             fmt::format("the {} tells {:.2f} bits of the {}, {:.2f} by chance (p = {:.4f}): {}",
                         question.name, bits, question.target_name, by_chance, p, question.danger),
             question.advice);
}

void check_shortcuts(const CheckInput& input, CheckReport& report) {
  struct Asked {
    const char* name;
    Field field;
    const char* advice;
  };
  for (const auto& [name, field, advice] :
       {Asked{"material", &ImageRecord::material, "materials.assign = \"all\" or \"balanced\""},
        Asked{"environment", &ImageRecord::environment,
              "environments.assign = \"all\" or \"balanced\""},
        Asked{"view", &ImageRecord::view, ""}}) {
    check_field(input, report,
                {name, field, "class", &ImageRecord::class_path,
                 "a classifier may learn it in place of the model", advice});
    // What is held out is meant to tell the split.
    if (split_by(input) != name)
      check_field(
          input, report,
          {name, field, "split", &ImageRecord::split, "what is tested was hardly seen", advice});
  }
}

}  // namespace

Check shortcuts_check() {
  return {"shortcuts",
          "what beside the model tells the class, or the split",
          check_shortcuts,
          {k_shortcuts_p, k_shortcuts_bits}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/film_facts.h"

#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <limits>

namespace ds {
namespace {

using nlohmann::json;

/// Calls `visit` with each field's name and the field, so that no field is written and not read.
template <typename Facts, typename Visit>
void visit_fields(Facts& facts, const Visit& visit) {
  visit("samples", facts.samples);
  visit("least_spp", facts.least_spp);
  visit("most_spp", facts.most_spp);
  visit("nan_samples", facts.nan_samples);
  visit("infinite_samples", facts.infinite_samples);
  visit("negative_samples", facts.negative_samples);
  visit("outlier_samples", facts.outlier_samples);
  visit("removed_energy", facts.removed_energy);
  visit("error_low", facts.error_low);
  visit("error_high", facts.error_high);
  visit("developed_error", facts.developed_error);
  visit("developed_low", facts.developed_low);
  visit("developed_high", facts.developed_high);
  visit("capped", facts.capped);
}

template <typename T>
json value_of(const T& field) {
  return field;
}
json value_of(const std::optional<double>& field) {
  return field ? json(*field) : json();
}

template <typename T>
bool take(const json& value, T& field) {
  if (!value.is_number_unsigned() ||
      value.get<std::uint64_t>() > std::uint64_t{std::numeric_limits<T>::max()})
    return false;
  field = value.get<T>();
  return true;
}
bool take(const json& value, bool& field) {
  if (!value.is_boolean()) return false;
  field = value.get<bool>();
  return true;
}
bool take(const json& value, double& field) {
  if (!value.is_number()) return false;
  field = value.get<double>();
  return true;
}
bool take(const json& value, std::optional<double>& field) {
  field.reset();
  return value.is_null() || take(value, field.emplace());
}

}  // namespace

json to_json_value(const FilmFacts& facts) {
  json object = json::object();
  visit_fields(facts, [&](const char* name, const auto& field) { object[name] = value_of(field); });
  return object;
}

FilmFacts film_facts_from(const json& object) {
  if (!object.is_object())
    fail(ErrorKind::asset, "film must be an object, got {}", object.type_name());
  FilmFacts facts;
  visit_fields(facts, [&](const char* name, auto& field) {
    const auto at = object.find(name);
    if (at != object.end() && !take(*at, field))
      fail(ErrorKind::asset, "film.{} must be a count, a number or a truth, got {}", name,
           at->dump(-1, ' ', false, json::error_handler_t::replace));
  });
  return facts;
}

std::string to_text(const FilmFacts& facts) {
  return canonical_json(to_json_value(facts));
}

FilmFacts film_facts_from_text(const std::string& text) {
  if (text.empty()) return {};
  try {
    return film_facts_from(json::parse(text));
  } catch (const json::exception& error) {
    fail(ErrorKind::asset, "no facts of a film: {}", json_fault(error));
  }
}

}  // namespace ds

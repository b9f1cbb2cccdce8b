// SPDX-License-Identifier: Apache-2.0
#include "manifests/draws.h"

#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace ds {
namespace {

using nlohmann::json;

json value_of(const std::vector<double>& numbers) {
  if (numbers.empty()) return {};
  return numbers.size() == 1 ? json(numbers.front()) : json(numbers);
}

[[noreturn]] void refuse(const std::string& key, const char* wanted, const json& found) {
  fail(ErrorKind::asset, "draws: {} must be {}, got {}", key, wanted,
       found.dump(-1, ' ', false, json::error_handler_t::replace));
}

/// Of a number or a list of some.
std::vector<double> numbers_of(const std::string& key, const json& value) {
  if (value.is_number()) return {value.get<double>()};
  const bool numbers = value.is_array() && !value.empty() &&
                       std::all_of(value.begin(), value.end(),
                                   [](const json& number) { return number.is_number(); });
  if (!numbers) refuse(key, "a number or a list of numbers", value);
  return value.get<std::vector<double>>();
}

}  // namespace

json to_json_value(const DrawRecords& draws) {
  json object = json::object();
  for (const auto& [key, draw] : draws)
    object[key] =
        draw.whole ? json(static_cast<std::int64_t>(draw.values.front())) : value_of(draw.values);
  return object;
}

DrawRecords draws_from(const json& value) {
  if (!value.is_object()) refuse("the field", "an object", value);
  DrawRecords draws;
  for (const auto& [key, member] : value.items())
    draws.emplace(key, DrawRecord{numbers_of(key, member), member.is_number_integer()});
  return draws;
}

json to_json_value(const DrawSummaries& draws) {
  json object = json::object();
  for (const auto& [key, draw] : draws)
    object[key] = {{"distribution", draw.distribution},
                   {"count", draw.count},
                   {"min", value_of(draw.least)},
                   {"max", value_of(draw.most)},
                   {"mean", value_of(draw.mean)}};
  return object;
}

DrawSummaries draw_summaries_from(const json& value) {
  if (!value.is_object()) refuse("the field", "an object", value);
  DrawSummaries draws;
  for (const auto& [key, member] : value.items()) {
    DrawSummary& draw = draws[key];
    const auto field = [&, &key = key, &member = member](const char* name) -> const json& {
      if (!member.is_object() || !member.contains(name))
        refuse(key, "an object with distribution, count, min, max and mean", member);
      return member[name];
    };
    const auto numbers = [&](const char* name, std::vector<double>& to) {
      if (!field(name).is_null()) to = numbers_of(name, field(name));
    };
    if (!field("distribution").is_string() || !field("count").is_number_unsigned())
      refuse(key, "an object with a text, distribution, and a count", member);
    draw.distribution = field("distribution").get<std::string>();
    draw.count = field("count").get<std::uint64_t>();
    numbers("min", draw.least);
    numbers("max", draw.most);
    numbers("mean", draw.mean);
  }
  return draws;
}

}  // namespace ds

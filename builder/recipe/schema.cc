// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/schema.h"

#include "builder/recipe/keys.h"
#include "builder/recipe/lights.h"
#include "builder/recipe/value.h"
#include "builder/recipe/variables.h"
#include "tracer/scene/told_lights.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace ds {
namespace {

using nlohmann::json;

json list_of(json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

json number_in(const char* type, const KeyRange& range) {
  json schema{{"type", type}};
  if (std::isfinite(range.least))
    schema[range.open_least ? "exclusiveMinimum" : "minimum"] = range.least;
  if (std::isfinite(range.most))
    schema[range.open_most ? "exclusiveMaximum" : "maximum"] = range.most;
  return schema;
}

json numbers_in(const KeyRange& range, std::size_t count) {
  json list = list_of(number_in("number", range));
  list["minItems"] = list["maxItems"] = count;
  return list;
}

json to_json(const RecipeValue& value) {
  if (const auto* text = value.text()) return *text;
  if (const auto* flag = value.boolean()) return *flag;
  if (const auto* whole = value.integer()) return *whole;
  if (value.is_number()) return value.number();
  if (value.table() != nullptr) return json::object();  // a default's is empty
  json list = json::array();
  if (const auto* array = value.array())
    for (const RecipeValue& element : *array)
      list.push_back(to_json(element));
  return list;
}

/// A value of one, or a distribution.
json schema_of(const LightKey& key) {
  json constant = number_in("number", key.range);
  std::string_view drawn = "number";
  json schema;
  switch (key.use) {
    case LightUse::flag:
      schema["type"] = "boolean";
      break;
    case LightUse::colour:
    case LightUse::point:
    case LightUse::source:
      drawn = key.use == LightUse::colour ? "colour" : "point";
      constant = numbers_in(key.range, 3);
      [[fallthrough]];
    default:
      schema["anyOf"] = {constant, {{"$ref", fmt::format("#/$defs/{}", drawn)}}};
  }
  if (key.use == LightUse::temperature) schema["anyOf"].push_back({{"const", false}});
  schema["description"] = key.unit.empty() ? key.help : fmt::format("{} ({})", key.help, key.unit);
  if (!key.default_value.empty()) schema["default"] = to_json(parse_value(key.default_value));
  return schema;
}

/// An entry of [[lights]], of any type.
json light_schema() {
  json types = json::array();
  for (const SdlTypeRow* type : told_light_types()) {
    json properties{{"type", {{"const", type->name}}},
                    {"name", {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}}},
                    {"count",
                     {{"anyOf",
                       {number_in("integer", {.least = 0, .most = k_most_lights}),
                        {{"$ref", "#/$defs/integer"}}}},
                      {"default", 1}}}};
    json required{"type"};
    for (const LightKey& key : light_keys(type->name)) {
      properties[key.name] = schema_of(key);
      if (key.default_value.empty()) required.push_back(key.name);
    }
    types.push_back({{"type", "object"},
                     {"description", type->help},
                     {"properties", properties},
                     {"required", required},
                     {"additionalProperties", false}});
  }
  return {{"anyOf", types}};
}

/// Null for a key that has literals alone.
json type_schema(const KeySpec& key) {
  switch (key.type) {
    case KeyType::text:
    case KeyType::path:
      return {{"type", "string"}};
    case KeyType::name:
      return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-][A-Za-z0-9._-]*$"}};
    case KeyType::path_list:
    case KeyType::text_list:
      return list_of({{"type", "string"}, {"minLength", 1}});
    case KeyType::choice:
      return nullptr;
    case KeyType::boolean:
      return {{"type", "boolean"}};
    case KeyType::integer:
      return number_in("integer", key.range);
    case KeyType::integer_list:
      return list_of({{"type", "integer"}, {"minimum", 0}});
    case KeyType::number:
      return number_in("number", key.range);
    case KeyType::point:
      return numbers_in(key.range, 3);
    case KeyType::quaternion:
      return numbers_in(key.range, 4);
    case KeyType::point_list:
      return list_of(numbers_in(key.range, 3));
    case KeyType::patterns: {
      json values{{"type", "number"}};
      json each{{"anyOf", {values, numbers_in({}, 3)}}};
      // Of what environments have, lights have places.
      for (const DrawnKind kind : {DrawnKind::number, DrawnKind::colour, DrawnKind::point})
        if (kind != DrawnKind::point || key.name.starts_with("environments."))
          each["anyOf"].push_back({{"$ref", fmt::format("#/$defs/{}", name_of(kind))}});
      return {{"type", "object"}, {"additionalProperties", each}};
    }
    case KeyType::lights:
      return list_of(light_schema());
  }
  return nullptr;
}

json literals_of(const KeySpec& key) {
  json literals = json::array();
  for (std::string_view rest = key.choices; !rest.empty();) {
    const std::size_t end = rest.find(" | ");
    literals.push_back(to_json(parse_value(rest.substr(0, end))));
    rest.remove_prefix(end == rest.npos ? rest.size() : end + 3);
  }
  return literals;
}

json numbers(std::size_t count) {
  json list = list_of({{"type", "number"}});
  list["minItems"] = list["maxItems"] = count;
  return list;
}

json rows(std::size_t count, std::size_t columns) {
  json list = list_of(numbers(columns));
  list["minItems"] = list["maxItems"] = count;
  return list;
}

/// Of candidates: a number or a list of some.
json constants(DrawnKind kind) {
  if (kind == DrawnKind::integer) return {{"type", "integer"}};
  return width_of(kind) == 1 ? json{{"type", "number"}} : numbers(width_of(kind));
}

json schema_of(const DistributionWord& word, DrawnKind kind) {
  json radius{{"type", "number"}, {"minimum", 0}};
  switch (word.shape) {
    case WordShape::range:
    case WordShape::parameters:
      return numbers(2);
    case WordShape::candidates: {
      json list = list_of(constants(kind));
      if (!word.by_view)
        list["items"] = {
            {"anyOf", {list["items"], {{"$ref", fmt::format("#/$defs/{}", name_of(kind))}}}}};
      list["minItems"] = 1;
      return list;
    }
    case WordShape::radius:
      return radius;
    case WordShape::radii:
      return {{"anyOf", {radius, numbers(2)}}};
    case WordShape::box:
      return rows(2, 3);
    case WordShape::hsv:
      return rows(3, 2);
    case WordShape::turn:
      return {{"enum", {"up", "any"}}};
  }
  return {};
}

json beside_schema(std::string_view name) {
  if (name == "per") return {{"enum", {"view", "model", "dataset"}}};
  if (name == "weights") return list_of({{"type", "number"}, {"minimum", 0}});
  return numbers(name == "at" ? 3 : 2);
}

/// The distributions that a key of this kind takes.
json distributions_of(DrawnKind kind) {
  json words = json::array();
  for (const DistributionWord& word : distribution_words()) {
    if (!may_draw(word, kind)) continue;
    json one{{"type", "object"},
             {"description", word.help},
             {"properties", {{word.name, schema_of(word, kind)}}},
             {"required", {word.name}},
             {"additionalProperties", false}};
    for (std::string_view name : word.beside) {
      if (name.ends_with('!')) {
        name.remove_suffix(1);
        one["required"].push_back(name);
      }
      one["properties"][std::string(name)] = beside_schema(name);
    }
    words.push_back(std::move(one));
  }
  return {{"anyOf", words}};
}

json schema_of(const KeySpec& key) {
  json schema = type_schema(key);
  json others = json::array();
  if (const json literals = literals_of(key); !literals.empty())
    others.push_back({{"enum", literals}});
  if (const VariableKey* row = find_variable(key.name))
    others.push_back({{"$ref", fmt::format("#/$defs/{}", name_of(row->kind))}});
  if (!others.empty() && schema.is_null() && others.size() == 1) {
    schema = others.front();
  } else if (!others.empty()) {
    if (!schema.is_null()) others.insert(others.begin(), schema);
    schema = {{"anyOf", others}};
  }
  std::string text = help_of(key);
  if (!key.unit.empty()) text += fmt::format(" ({})", key.unit);
  if (!key.only_with.empty()) text += fmt::format(". Only with {}", key.only_with);
  schema["description"] = text;
  if (key.has_default()) schema["default"] = to_json(parse_value(key.default_value));
  return schema;
}

/// The section of a key, made where it is not there: camera of camera.fov_deg, classes and split of
/// classes.split.test.
json& section_of(json& root, std::string_view& name) {
  json* at = &root;
  for (std::size_t dot = name.find('.'); dot != name.npos; dot = name.find('.')) {
    json& section = (*at)["properties"][std::string(name.substr(0, dot))];
    if (section.is_null())
      section = {
          {"type", "object"}, {"properties", json::object()}, {"additionalProperties", false}};
    at = &section;
    name.remove_prefix(dot + 1);
  }
  return *at;
}

}  // namespace

nlohmann::json recipe_schema() {
  json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
            {"title", "A recipe of dsbuild"},
            {"type", "object"},
            {"properties", json::object()},
            {"additionalProperties", false}};
  for (const KeySpec& key : recipe_keys()) {
    std::string_view name = key.name;
    json& section = section_of(root, name);
    section["properties"][std::string(name)] = schema_of(key);
  }
  root["$defs"]["colour"] = distributions_of(DrawnKind::colour);
  for (const VariableKey& row : variable_keys())
    root["$defs"][std::string(name_of(row.kind))] = distributions_of(row.kind);
  return root;
}

}  // namespace ds

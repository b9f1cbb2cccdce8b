// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/planes.h"

#include "tracer/base/nearest.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace ds {
namespace {

std::vector<std::string_view> plane_names() {
  std::vector<std::string_view> names;
  for (const PlaneType& type : plane_types())
    names.push_back(type.name);
  return names;
}

std::vector<std::string_view> encoding_names(const PlaneType& type) {
  std::vector<std::string_view> names;
  for (const PlaneEncoding encoding : encodings_of(type))
    names.push_back(name_of(encoding));
  return names;
}

const PlaneType* find_by_any_name(const std::string& name) {
  if (name == "DEPTH") return find_plane("distance");
  const bool is_capital =
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c) != 0; });
  std::string lower = name;
  if (is_capital)
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return find_plane(lower);
}

/// "depth" or "depth:half"; nothing, with a finding, for what is none.
std::optional<PlaneOutput> read_plane(const Settings& settings, const RecipeValue& value) {
  constexpr std::string_view k_key = "outputs.planes";
  const std::string& text = *value.text();
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const PlaneType* type = find_by_any_name(name);
  if (type == nullptr) {
    const std::string_view meant = nearest(name, plane_names());
    settings.complain(
        value, k_key,
        fmt::format("wanted planes ({}), got {:?}{}", fmt::join(plane_names(), ", "), name,
                    meant.empty() ? "" : fmt::format(", did you mean {}?", meant)));
    return std::nullopt;
  }
  const std::vector<PlaneEncoding> encodings = encodings_of(*type);
  if (colon == text.npos) return PlaneOutput{type, encodings.front()};
  const std::string wanted = text.substr(colon + 1);
  for (const PlaneEncoding encoding : encodings)
    if (name_of(encoding) == wanted) return PlaneOutput{type, encoding};
  settings.complain(value, k_key,
                    fmt::format("wanted {} as {}, got {:?}", type->name,
                                fmt::join(encoding_names(*type), ", "), wanted));
  return std::nullopt;
}

/// outputs.mask and outputs.depth, where the recipe gives them, say the same of their plane as outputs.planes.
void check_said_twice(const Settings& settings, const PlaneOutput& plane) {
  const std::string key = fmt::format("outputs.{}", plane.type->name);
  const bool has_key = key == "outputs.mask" || key == "outputs.depth";
  if (!has_key || !settings.given(key) || settings.wrong(key)) return;
  const std::string_view wanted = name_of(plane.encoding);
  const std::string literal = settings.literal(key);
  if (literal == "true" || literal == fmt::format("{:?}", wanted)) return;
  settings.complain(key,
                    fmt::format("is {}, and outputs.planes has {} as {}; wanted one of the two",
                                literal == "false" ? "off" : literal, plane.type->name, wanted));
}

}  // namespace

const PlaneOutput* OutputSettings::find_plane(std::string_view name) const {
  const auto found = std::find_if(planes.begin(), planes.end(),
                                  [&](const PlaneOutput& one) { return one.type->name == name; });
  return found == planes.end() ? nullptr : &*found;
}

void OutputSettings::set_plane(PlaneOutput plane) {
  // Types are rows of one table.
  const auto at = std::find_if(planes.begin(), planes.end(),
                               [&](const PlaneOutput& one) { return one.type >= plane.type; });
  if (at != planes.end() && at->type == plane.type)
    *at = plane;
  else
    planes.insert(at, plane);
}

std::vector<PlaneOutput> read_planes(const Settings& settings) {
  OutputSettings outputs;
  if (settings.boolean("outputs.mask"))
    outputs.set_plane({&plane_type("mask"), PlaneEncoding::png8});
  if (settings.find("outputs.depth")->text() != nullptr)
    outputs.set_plane({&plane_type("depth"), PlaneEncoding::exr});
  std::vector<const PlaneType*> named;
  for (const RecipeValue& value : *settings.find("outputs.planes")->array()) {
    const std::optional<PlaneOutput> plane = read_plane(settings, value);
    if (!plane) continue;
    if (std::find(named.begin(), named.end(), plane->type) != named.end())
      settings.complain(value, "outputs.planes", fmt::format("names {} twice", plane->type->name));
    else
      check_said_twice(settings, *plane);
    named.push_back(plane->type);
    outputs.set_plane(*plane);
  }
  return outputs.planes;
}

std::string plane_meant(std::string_view key, const RecipeValue& value) {
  constexpr std::string_view k_section = "outputs.";
  if (!key.starts_with(k_section) || key == "outputs.mask") return "";
  const PlaneType* type = find_by_any_name(std::string(key.substr(k_section.size())));
  if (type == nullptr) return "";
  const std::string text = value.text() != nullptr ? *value.text() : "";
  std::string plane(type->name);
  for (const PlaneEncoding encoding : encodings_of(*type))
    if (!text.empty() && name_of(encoding).starts_with(text)) {
      plane += fmt::format(":{}", name_of(encoding));
      break;
    }
  return fmt::format("; outputs.planes = [\"{}\"] writes it", plane);
}

std::string plane_reference() {
  std::string text = "| Plane | Numbers | Encodings | Meaning |\n|---|---|---|---|\n";
  for (const PlaneType& type : plane_types())
    text += fmt::format("| `{}` | {} | {} | {} |\n", type.name, type.width,
                        fmt::join(encoding_names(type), ", "), header_comment("planes", type.name));
  return text;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_parameters.h"

#include "tracer/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace ds {
namespace {

std::string_view type_text(SdlType type) {
  switch (type) {
    case SdlType::number:
      return "a number";
    case SdlType::flag:
      return "0, 1, true or false";
    case SdlType::color:
    case SdlType::vector:
      return "three numbers";
    case SdlType::pair:
      return "two numbers";
    case SdlType::matrix:
      return "16 numbers, column by column";
    case SdlType::id:
      return "a whole number";
    case SdlType::text:
      return "a name";
    case SdlType::choice:
      return "";
    case SdlType::file:
      return "a file";
    case SdlType::list:
      return "numbers";
    case SdlType::scalar_input:
      return "a number or a texture's name";
    case SdlType::color_input:
      return "one or three numbers or a texture's name";
  }
  return "";
}

std::string default_cell(const SdlParameter& parameter) {
  return parameter.default_value.empty() ? "none" : "`" + parameter.default_value + "`";
}

std::string rows_of(const std::vector<SdlParameter>& parameters) {
  if (parameters.empty()) return "";
  std::string text =
      "| property | type and range | default | what it does |\n| --- | --- | --- | --- |\n";
  for (const SdlParameter& p : parameters)
    text +=
        fmt::format("| `{}` | {} | {} | {} |\n", p.name, wanted_text(p), default_cell(p), p.help);
  return text + "\n";
}

std::string no_effect_text(SdlKind kind) {
  std::string text;
  for (const NoEffect& entry : no_effect_properties(kind))
    text += fmt::format("{}`{}`{}", text.empty() ? "" : ", ", entry.name,
                        entry.value == "*" ? "" : fmt::format(" = {}", entry.value));
  return text.empty() ? "" : "Accepted, and without effect: " + text + ".\n\n";
}

}  // namespace

const SdlSection& sdl_section(SdlKind kind) {
  switch (kind) {
    case SdlKind::texture:
      return texture_section();
    case SdlKind::material:
      return material_section();
    case SdlKind::shape:
      return shape_section();
    case SdlKind::object:
      return object_section();
    case SdlKind::light:
      return light_section();
    case SdlKind::film:
      return film_section();
  }
  return texture_section();
}

std::vector<const SdlSection*> sdl_sections() {
  return {&texture_section(), &material_section(), &shape_section(),
          &object_section(),  &light_section(),    &film_section()};
}

const SdlTypeRow* find_type(const SdlSection& section, std::string_view type) {
  const auto at = std::find_if(section.types.begin(), section.types.end(),
                               [&](const SdlTypeRow& row) { return row.name == type; });
  return at == section.types.end() ? nullptr : &*at;
}

const SdlParameter* find_parameter(const SdlSection& section, const SdlTypeRow* row,
                                   std::string_view name) {
  const auto find = [&](const std::vector<SdlParameter>& all) -> const SdlParameter* {
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const SdlParameter& p) { return p.name == name; });
    return at == all.end() ? nullptr : &*at;
  };
  if (row != nullptr)
    if (const SdlParameter* own = find(row->parameters)) return own;
  return find(section.common);
}

std::vector<std::string_view> parameter_names(const SdlSection& section, const SdlTypeRow* row) {
  std::vector<std::string_view> names;
  if (row != nullptr)
    for (const SdlParameter& p : row->parameters)
      names.emplace_back(p.name);
  for (const SdlParameter& p : section.common)
    names.emplace_back(p.name);
  return names;
}

std::vector<std::string_view> type_names(const SdlSection& section) {
  std::vector<std::string_view> names;
  for (const SdlTypeRow& row : section.types)
    names.emplace_back(row.name);
  return names;
}

std::string wanted_text(const SdlParameter& parameter) {
  if (parameter.type == SdlType::choice) {
    const std::vector<std::string_view>& all = parameter.choices;
    if (all.size() < 2) return std::string(all.empty() ? "" : all.front());
    return fmt::format("{} or {}", fmt::join(all.begin(), all.end() - 1, ", "), all.back());
  }
  std::string text(type_text(parameter.type));
  const std::string range = parameter.range.text();
  if (range.empty()) return text;
  // "a number in [0, 1] or a texture's name"
  const std::size_t end =
      parameter.type == SdlType::scalar_input || parameter.type == SdlType::color_input
          ? text.rfind(" or ")
          : text.size();
  return text.insert(end, " " + range);
}

std::string sdl_reference() {
  std::string text;
  for (const SdlSection* section : sdl_sections()) {
    text += fmt::format("{}## {}\n\n{}\n\n", text.empty() ? "" : "\n", section_of(section->kind),
                        section->help);
    if (!section->default_type.empty())
      text += fmt::format("Without a `type` it is `{}`.\n\n", section->default_type);
    if (!section->common.empty() && section->types.size() > 1) text += "Every type has\n\n";
    text += rows_of(section->common);
    text += no_effect_text(section->kind);
    for (const SdlTypeRow& row : section->types) {
      if (!row.name.empty()) text += fmt::format("### {}\n\n{}\n\n", row.name, row.help);
      text += rows_of(row.parameters);
    }
    text.pop_back();  // one line break at the end
  }
  return text;
}

std::string told_text(const Parameter& told) {
  if (told.kind != ParameterKind::share) return std::string(told.help);
  return fmt::format("{}{}a share of light, {}; what is not is warned of", told.help,
                     told.help.empty() ? "" : "; ", physical_range(told).text());
}

std::vector<SdlParameter> header_parameters(const NodeType& type) {
  std::vector<SdlParameter> parameters;
  for (const InputType& input : type.inputs)
    parameters.push_back(
        {std::string(input.name), input.width == 1 ? SdlType::scalar_input : SdlType::color_input,
         fmt::format("{}", input.default_value), told_text(input.told), input.told.range});
  for (const NumberType& number : type.numbers) {
    const bool flag = number.told.kind == ParameterKind::flag;
    parameters.push_back({std::string(number.name), flag ? SdlType::flag : SdlType::number,
                          fmt::format("{}", number.default_value), told_text(number.told),
                          number.told.range});
  }
  return parameters;
}

std::vector<SdlParameter> concatenated(std::vector<std::vector<SdlParameter>> lists) {
  std::vector<SdlParameter> all;
  for (std::vector<SdlParameter>& list : lists)
    std::move(list.begin(), list.end(), std::back_inserter(all));
  return all;
}

}  // namespace ds

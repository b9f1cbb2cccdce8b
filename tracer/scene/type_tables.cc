// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/type_tables.h"

#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/lists.h"

#include <algorithm>
#include <array>

namespace ds {
namespace {

/// "matte_kd" of material "matte" is input "kd".
constexpr std::string_view without_prefix(std::string_view slot, std::string_view prefix) {
  return slot.substr(prefix.size() + 1);
}

// An empty list needs an array of some length; the last, unnamed row is not part of the span.
#define DS_INPUT_ROW(slot, width, default_value) InputType{#slot, width, default_value},
#define DS_NUMBER_ROW(slot, default_value) NumberType{#slot, default_value},
#define DS_NODE_LISTS(sdl_name, prefix, PREFIX)                                  \
  static std::array prefix##_input_rows = {DS_##PREFIX##_INPUTS(DS_INPUT_ROW)    \
                                               InputType{"", 0, 0.0f}};          \
  static std::array prefix##_number_rows = {DS_##PREFIX##_NUMBERS(DS_NUMBER_ROW) \
                                                NumberType{"", 0.0f}};

template <typename Row, std::size_t Size>
std::span<const Row> named_rows(std::array<Row, Size>& rows, std::string_view prefix) {
  for (Row& row : std::span(rows).first(Size - 1))
    row.name = without_prefix(row.name, prefix);
  return std::span<const Row>(rows).first(Size - 1);
}

#define DS_NODE_ROW(sdl_name, prefix, PREFIX)                           \
  NodeType{sdl_name, #prefix, named_rows(prefix##_input_rows, #prefix), \
           named_rows(prefix##_number_rows, #prefix)},

std::span<const NodeType> make_material_types() {
  DS_ALL_MATERIALS(DS_NODE_LISTS)
  static const std::array rows = {DS_ALL_MATERIALS(DS_NODE_ROW)};
  return rows;
}

std::span<const NodeType> make_texture_types() {
  DS_ALL_TEXTURES(DS_NODE_LISTS)
  static const std::array rows = {DS_ALL_TEXTURES(DS_NODE_ROW)};
  return rows;
}

template <typename Row>
int find_named(std::span<const Row> rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  return found == rows.end() ? -1 : static_cast<int>(found - rows.begin());
}

}  // namespace

std::span<const NodeType> material_types() {
  static const std::span<const NodeType> rows = make_material_types();
  return rows;
}

std::span<const NodeType> texture_types() {
  static const std::span<const NodeType> rows = make_texture_types();
  return rows;
}

int find_type(std::span<const NodeType> types, std::string_view name) {
  return find_named(types, name);
}
int find_input(const NodeType& type, std::string_view name) {
  return find_named(type.inputs, name);
}
int find_number(const NodeType& type, std::string_view name) {
  return find_named(type.numbers, name);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/type_tables.h"

#include "tracer/base/error.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/kernels/embedded.h"
#include "tracer/kernels/lists.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace ds {
namespace {

/// "matte_kd" of material "matte" is input "kd".
constexpr std::string_view without_prefix(std::string_view slot, std::string_view prefix) {
  return slot.substr(prefix.size() + 1);
}

// An empty list needs an array of some length; the last, unnamed row is not part of the span.
#define DS_INPUT_ROW(slot, width, default_value) InputType{#slot, width, default_value, {}},
#define DS_NUMBER_ROW(slot, default_value) NumberType{#slot, default_value, {}},
#define DS_NODE_LISTS(sdl_name, prefix, PREFIX)                                  \
  static std::array prefix##_input_rows = {DS_##PREFIX##_INPUTS(DS_INPUT_ROW)    \
                                               InputType{"", 0, 0.0f, {}}};      \
  static std::array prefix##_number_rows = {DS_##PREFIX##_NUMBERS(DS_NUMBER_ROW) \
                                                NumberType{"", 0.0f, {}}};

/// Inputs or numbers with what `told`, as many rows, says of them.
template <typename Row, std::size_t Size>
std::span<const Row> told_rows(std::array<Row, Size>& rows, std::span<const Parameter> told,
                               std::string_view prefix) {
  for (std::size_t i = 0; i + 1 < Size; ++i) {
    rows[i].name = without_prefix(rows[i].name, prefix);
    rows[i].told = told[i];
  }
  return std::span<const Row>(rows).first(Size - 1);
}

/// Whether a header's parameters are its inputs, then its numbers, of these names.
template <std::size_t Size>
constexpr bool tells_all(const std::array<std::string_view, Size>& slots, std::string_view prefix,
                         std::span<const Parameter> told) {
  if (told.size() + 1 != Size) return false;
  for (std::size_t i = 0; i < told.size(); ++i)
    if (without_prefix(slots[i], prefix) != told[i].name) return false;
  return true;
}

#define DS_INPUT_NAME(slot, width, default_value) #slot,
#define DS_NUMBER_NAME(slot, default_value) #slot,
#define DS_TELLS_ALL(sdl_name, prefix, PREFIX)                                           \
  static_assert(tells_all(std::to_array<std::string_view>({DS_##PREFIX##_INPUTS(         \
                              DS_INPUT_NAME) DS_##PREFIX##_NUMBERS(DS_NUMBER_NAME) ""}), \
                          #prefix, kernels::prefix##_on_host.parameters),                \
                #prefix "_parameters of its header names all inputs, then all numbers, in order");

#define DS_NODE_ROW(sdl_name, prefix, PREFIX, children)                                           \
  NodeType{                                                                                       \
      sdl_name,                                                                                   \
      #prefix,                                                                                    \
      unsigned{kernels::prefix##_traits},                                                         \
      children,                                                                                   \
      told_rows(prefix##_input_rows, kernels::prefix##_on_host.parameters, #prefix),              \
      told_rows(prefix##_number_rows,                                                             \
                kernels::prefix##_on_host.parameters.subspan(std::size(prefix##_input_rows) - 1), \
                #prefix),                                                                         \
      kernels::prefix##_on_host},
#define DS_MATERIAL_ROW(sdl_name, prefix, PREFIX) \
  DS_NODE_ROW(sdl_name, prefix, PREFIX, kernels::prefix##_children)
#define DS_TEXTURE_ROW(sdl_name, prefix, PREFIX) DS_NODE_ROW(sdl_name, prefix, PREFIX, 0)
#define DS_CHILDREN_FIT(sdl_name, prefix, PREFIX) \
  static_assert(int{kernels::prefix##_children} <= int{kernels::k_most_children});
DS_ALL_MATERIALS(DS_CHILDREN_FIT)
DS_ALL_MATERIALS(DS_TELLS_ALL)
DS_ALL_TEXTURES(DS_TELLS_ALL)

// Cameras of one span have one key of the recipe, so they must agree on it.
constexpr bool agrees(const DS_KERNELS::CameraOnHost& a, const DS_KERNELS::CameraOnHost& b) {
  return a.span != b.span ||
         (a.default_value == b.default_value && a.range.least == b.range.least &&
          a.range.most == b.range.most && a.range.open_least == b.range.open_least &&
          a.range.open_most == b.range.open_most);
}
constexpr bool cameras_agree() {
#define DS_CAMERA_ON_HOST(name) kernels::name##_on_host,
  constexpr std::array all = {DS_ALL_CAMERAS(DS_CAMERA_ON_HOST)};
#undef DS_CAMERA_ON_HOST
  for (const auto& a : all)
    for (const auto& b : all)
      if (!agrees(a, b)) return false;
  return true;
}
static_assert(cameras_agree(), "cameras of one span differ in its default or range");

#define DS_LIGHT_ROW(sdl_name, prefix) \
  LightType{sdl_name, #prefix, unsigned{kernels::prefix##_traits}, kernels::prefix##_on_host},
#define DS_IS_MET(sdl_name, prefix) \
  static_assert((int{kernels::prefix##_traits} & int{kernels::k_trait_beyond}) != 0);
#define DS_IS_UNMET(sdl_name, prefix) \
  static_assert((int{kernels::prefix##_traits} & int{kernels::k_trait_beyond}) == 0);
DS_BEYOND_LIGHTS(DS_IS_MET)
DS_UNMET_LIGHTS(DS_IS_UNMET)
#define DS_COLOR_IS_FIRST(sdl_name, prefix) \
  static_assert(kernels::prefix##_inputs[0].value == LightValue::color);
DS_SCENE_LIGHTS(DS_COLOR_IS_FIRST)

std::span<const NodeType> make_material_types() {
  DS_ALL_MATERIALS(DS_NODE_LISTS)
  static const std::array rows = {DS_ALL_MATERIALS(DS_MATERIAL_ROW)};
  return rows;
}

std::span<const NodeType> make_texture_types() {
  DS_ALL_TEXTURES(DS_NODE_LISTS)
  static const std::array rows = {DS_ALL_TEXTURES(DS_TEXTURE_ROW)};
  return rows;
}

/// How many of a light's values stand before those of an input; of all for none of that name.
std::size_t values_before(const LightType& type, std::string_view input) {
  std::size_t count = 0;
  for (const LightInput& one : type.host.inputs) {
    if (one.name == input) break;
    if (one.value != LightValue::color) count += static_cast<std::size_t>(one.width());
  }
  return count;
}

template <typename Row>
int find_named(std::span<const Row> rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  return found == rows.end() ? -1 : static_cast<int>(found - rows.begin());
}

}  // namespace

NumberRange kept_range(std::string_view input) {
  NumberRange kept;
  for (const auto types : {material_types(), texture_types()})
    for (const NodeType& type : types) {
      const int at = find_input(type, input);
      if (at < 0) continue;
      const Parameter& told = type.inputs[static_cast<std::size_t>(at)].told;
      for (const NumberRange& range : {told.range, physical_range(told)}) {
        kept.least = std::max(kept.least, range.least);
        kept.most = std::min(kept.most, range.most);
      }
    }
  return kept;
}

std::string header_comment(std::string_view folder, std::string_view prefix) {
  const std::string path = fmt::format("tracer/kernels/{}/{}.h", folder, prefix);
  const auto files = std::span(k_embedded_files, k_embedded_file_count);
  const auto file = std::find_if(files.begin(), files.end(),
                                 [&](const EmbeddedFile& f) { return path == f.path; });
  DS_ASSERT(file != files.end());
  std::string_view text = file->text;
  std::string comment;
  for (bool licence = true; text.starts_with("//"); licence = false) {
    std::string_view line = text.substr(2, text.find('\n') - 2);
    text.remove_prefix(line.size() + 3);
    if (licence) continue;
    if (line.empty()) break;
    comment += comment.empty() ? line.substr(1) : line;
  }
  return comment;
}

bool reads_uvs(const NodeType& texture) {
  return has_trait(texture, kernels::k_trait_uv);
}
bool reads_colors(const NodeType& texture) {
  return has_trait(texture, kernels::k_trait_colors);
}

std::span<const NodeType> material_types() {
  static const std::span<const NodeType> rows = make_material_types();
  return rows;
}

std::span<const NodeType> texture_types() {
  static const std::span<const NodeType> rows = make_texture_types();
  return rows;
}

std::span<const LightType> light_types() {
  static constexpr std::array rows = {LightType{"", "mesh", unsigned{kernels::mesh_traits}, {}},
                                      DS_SCENE_LIGHTS(DS_LIGHT_ROW)};
  return rows;
}

const LightType& light_type(std::string_view prefix) {
  const auto row =
      std::find_if(light_types().begin(), light_types().end(),
                   [&](const LightType& type) { return type.kernel_prefix == prefix; });
  DS_ASSERT(row != light_types().end());
  return *row;
}

const LightType& type_of(const Light& light) {
  return light_types()[static_cast<std::size_t>(light.type)];
}

Light make_light(std::string_view prefix) {
  Light light;
  const LightType& type = light_type(prefix);
  light.type = static_cast<int>(&type - light_types().data());
  light.values.resize(values_before(type, ""));
  return light;
}

const float* light_value(const Light& light, std::string_view input) {
  const std::size_t at = values_before(type_of(light), input);
  DS_ASSERT(at < light.values.size());
  return light.values.data() + at;
}

float* light_value(Light& light, std::string_view input) {
  return const_cast<float*>(light_value(std::as_const(light), input));
}

void set_light_value(Light& light, std::string_view input, Vec3 value) {
  float* to = light_value(light, input);
  to[0] = value.x;
  to[1] = value.y;
  to[2] = value.z;
}

Vec3 light_vector(const Light& light, std::string_view input) {
  const float* v = light_value(light, input);
  return {v[0], v[1], v[2]};
}

std::span<const CameraType> camera_types() {
#define DS_CAMERA_ROW(name) CameraType{#name, kernels::name##_on_host},
  static constexpr std::array rows = {DS_ALL_CAMERAS(DS_CAMERA_ROW)};
#undef DS_CAMERA_ROW
  return rows;
}

int find_camera_type(std::string_view name) {
  return find_named(camera_types(), name);
}

const CameraType& type_of(const Camera& camera) {
  DS_ASSERT(camera.type >= 0 && static_cast<std::size_t>(camera.type) < camera_types().size());
  return camera_types()[static_cast<std::size_t>(camera.type)];
}

double& span_of(Camera& camera) {
  return type_of(camera).host.span == kernels::CameraSpan::fov_deg ? camera.fov_deg
                                                                   : camera.extent_m;
}
double span_of(const Camera& camera) {
  Camera copy = camera;
  return span_of(copy);
}

ShownSides shown_by(const Camera& camera, int width, int height) {
  const kernels::CameraShape shape = type_of(camera).host.shape(span_of(camera));
  const double longer = std::max(width, height);
  return {shape.at_camera_m * width / longer, shape.at_camera_m * height / longer,
          shape.per_metre * width / longer, shape.per_metre * height / longer};
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

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/vary_nodes.h"

#include "tracer/base/error.h"
#include "tracer/base/text_lines.h"
#include "tracer/scene/sdl_node.h"
#include "tracer/scene/sdl_prune.h"
#include "tracer/scene/sdl_reader.h"
#include "tracer/scene/sdl_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace ds {
namespace {

constexpr std::string_view k_scene = "scene.";
constexpr std::array k_kinds = {SdlKind::texture, SdlKind::material, SdlKind::light};

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  const std::size_t end = text.find_last_not_of(" \t");
  return begin == text.npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

/// Whether the line gives a property that node_lines keeps.
bool is_of_nodes(std::string_view line) {
  const std::string_view name = without_blanks(line.substr(0, line.find('=')));
  if (std::any_of(k_kinds.begin(), k_kinds.end(), [&](SdlKind kind) {
        return name.starts_with(fmt::format("{}.", section_of(kind)));
      }))
    return true;
  return name.starts_with(fmt::format("{}.", section_of(SdlKind::object))) &&
         name.ends_with(".material");
}

/// Names that a property has as its value, which a type's may be, too.
std::set<std::string> referred_names(const PropertySet& properties) {
  std::set<std::string> names;
  for (const Property* property : properties.unused())
    if (property->values.size() == 1 && !property->name.ends_with(".type"))
      names.insert(property->values[0]);
  return names;
}

std::optional<double> number_of(const std::vector<std::string>& words) {
  return words.size() == 1 ? parse_sdl_number(words[0]) : std::nullopt;
}

std::optional<Vec3d> three_of(const std::vector<std::string>& words, double gamma) {
  if (words.size() != 3) return std::nullopt;
  std::array<double, 3> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = parse_sdl_number(words[i]);
    if (!number) return std::nullopt;
    v[i] = linear(*number, gamma);
  }
  return Vec3d{v[0], v[1], v[2]};
}

std::optional<Vec3d> grey(std::optional<double> number) {
  return number ? std::optional(Vec3d{*number, *number, *number}) : std::nullopt;
}

/// What stands there, as numbers; nothing for a texture's name and what the reader would take otherwise.
std::optional<Vec3d> value_of(const SdlParameter& parameter, const Property* found) {
  std::vector<std::string> words =
      words_of(found != nullptr ? *found : Property{{}, {parameter.default_value}, {}, false});
  switch (parameter.type) {
    case SdlType::number:
    case SdlType::scalar_input:
      return grey(number_of(words));
    case SdlType::vector:
      return three_of(words, 1);
    case SdlType::color:
    case SdlType::color_input: {
      const std::optional<double> gamma = take_color_space(words);
      if (!gamma) return std::nullopt;
      if (const auto number = number_of(words); number && *gamma == 1) return grey(number);
      return three_of(words, *gamma);
    }
    default:
      return std::nullopt;
  }
}

/// How many numbers it is. Fixed numbers that have a range are whole ones and switches.
int width_of(SdlKind kind, const SdlTypeRow& row, const SdlParameter& parameter) {
  switch (parameter.type) {
    case SdlType::color:
    case SdlType::vector:
    case SdlType::color_input:
      return 3;
    case SdlType::scalar_input:
      return 1;
    case SdlType::number: {
      const auto types = kind == SdlKind::material ? material_types() : texture_types();
      const int type = kind == SdlKind::light ? -1 : find_type(types, row.name);
      if (type < 0) return 1;
      const NodeType& of = types[static_cast<std::size_t>(type)];
      const int number = find_number(of, parameter.name);
      return number >= 0 &&
                     of.numbers[static_cast<std::size_t>(number)].told.kind == ParameterKind::whole
                 ? 0
                 : 1;
    }
    default:
      return 0;
  }
}

NumberRange range_of(const SdlParameter& parameter) {
  NumberRange range = parameter.range;
  if (parameter.type != SdlType::scalar_input && parameter.type != SdlType::color_input)
    return range;
  const NumberRange physical = kept_range(parameter.name);
  range.least = std::max(range.least, physical.least);
  range.most = std::min(range.most, physical.most);
  return range;
}

void add_properties(const PropertySet& properties, SdlKind kind, const std::string& node,
                    std::vector<NodeProperty>& found) {
  const SdlSection& section = sdl_section(kind);
  const std::string prefix = fmt::format("{}.{}", section_of(kind), node);
  const Property* type = properties.find(prefix + ".type");
  const SdlTypeRow* row =
      find_type(section, type != nullptr ? std::string_view(type->values.front())
                                         : std::string_view(section.default_type));
  if (row == nullptr) return;
  for (const std::string_view name : parameter_names(section, row)) {
    const SdlParameter& parameter = *find_parameter(section, row, name);
    const bool colour = parameter.type == SdlType::color || parameter.type == SdlType::color_input;
    const std::string in_file = prefix + "." + parameter.name;
    found.push_back({kind, node, parameter.name, in_file.substr(k_scene.size()),
                     width_of(kind, *row, parameter), colour, range_of(parameter),
                     value_of(parameter, properties.find(in_file))});
  }
}

PropertySet parse(const std::string& nodes, const std::filesystem::path& folder,
                  Diagnostics& diagnostics) {
  return PropertySet::parse(nodes, (folder / "environment.scn").string(), diagnostics);
}

std::vector<std::string> words_of(const NodeValue& value) {
  if (value.width == 1) return {fmt::format("{}", value.value.x)};
  return {fmt::format("{}", value.value.x), fmt::format("{}", value.value.y),
          fmt::format("{}", value.value.z)};
}

/// The scene's light as it is.
void put_light(SdlReader& reader, const Scene& from, const std::string& name) {
  const auto known = std::find_if(from.lights.begin(), from.lights.end(),
                                  [&](const Light& light) { return light.name == name; });
  if (known == from.lights.end()) return;
  Light light = *known;
  if (light.image >= 0) {
    reader.scene.images.push_back(from.images[static_cast<std::size_t>(light.image)]);
    light.image = static_cast<int>(reader.scene.images.size()) - 1;
  }
  reader.scene.lights.push_back(std::move(light));
}

/// Of images that the scene has without reading them.
ContentOf contents_of(const Scene& scene) {
  return [&scene](const std::filesystem::path& file) {
    for (const Image& image : scene.images)
      if (image.file == file) return image.content;
    return content_hash(file);
  };
}

}  // namespace

std::string node_lines(std::string_view scene_text) {
  scene_text = without_bom(scene_text);
  std::string lines;
  while (!scene_text.empty()) {
    const std::string_view line = take_line(scene_text);
    if (is_of_nodes(line)) lines += line;
    lines += '\n';
  }
  return lines;
}

std::vector<NodeProperty> node_properties(const std::string& nodes,
                                          const std::filesystem::path& folder) {
  Diagnostics diagnostics(ErrorKind::asset);
  const PropertySet properties = parse(nodes, folder, diagnostics);
  const std::set<std::string> referred = referred_names(properties);
  std::vector<NodeProperty> found;
  for (const SdlKind kind : k_kinds)
    for (const std::string& node : properties.names_below(section_of(kind)))
      if (kind == SdlKind::light || referred.contains(node))
        add_properties(properties, kind, node, found);
  return found;
}

Scene with_node_values(const Scene& environment, const std::string& nodes,
                       const std::filesystem::path& folder, std::span<const NodeValue> values) {
  Diagnostics diagnostics(ErrorKind::asset);
  SdlReader reader(parse(nodes, folder, diagnostics), folder, diagnostics);
  reader.environment = true;
  reader.content_of = contents_of(environment);
  std::set<std::string> changed;  // "scene.lights.warm"
  for (const NodeValue& value : values) {
    std::string name = fmt::format("{}{}", k_scene, value.property);
    changed.insert(name.substr(0, name.find('.', name.find('.', k_scene.size()) + 1)));
    reader.properties.put(std::move(name), words_of(value));
  }
  read_textures(reader);
  read_materials(reader);
  diagnostics.throw_if_any();
  put_objects(reader, environment);
  const std::string_view lights = section_of(SdlKind::light);
  for (const std::string& name : reader.properties.names_below(lights))
    if (changed.contains(fmt::format("{}.{}", lights, name)))
      read_light(reader, name);
    else
      put_light(reader, environment, name);
  diagnostics.throw_if_any();
  Scene scene = prune_environment(std::move(reader.scene));
  scene.tone_map = environment.tone_map;
  scene.mended_meshes = environment.mended_meshes;
  scene.lost_faces = environment.lost_faces;
  scene.unlikely = environment.unlikely;
  return scene;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/told_lights.h"

#include "tracer/base/error.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_reader.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

namespace ds {
namespace {

/// "NAME.PROPERTY: wanted ..." of "NAME:3: scene.lights.NAME.PROPERTY: wanted ...".
std::string without_place(const std::string& line) {
  constexpr std::string_view k_section = "scene.lights.";
  const std::size_t at = line.find(k_section);
  return at == line.npos ? line : line.substr(at + k_section.size());
}

}  // namespace

const std::vector<const SdlTypeRow*>& told_light_types() {
  static const std::vector<const SdlTypeRow*> types = [] {
    std::vector<const SdlTypeRow*> made;
    for (const LightType& type : light_types())
      if (!type.name.empty() && (type.host.made_by & kernels::k_host_panorama) == 0)
        made.push_back(find_type(light_section(), type.name));
    return made;
  }();
  return types;
}

Light make_told_light(const ToldLight& told) {
  const std::string prefix = "scene.lights." + told.name + ".";
  PropertySet properties;
  properties.put(prefix + "type", {told.type});
  for (const auto& [property, numbers] : told.values) {
    std::vector<std::string> words;
    for (const double number : numbers)
      words.push_back(fmt::format("{}", number));
    properties.put(prefix + property, std::move(words));
  }
  Diagnostics diagnostics(ErrorKind::asset);
  SdlReader reader(std::move(properties), {}, diagnostics);
  read_light(reader, told.name);
  if (!diagnostics.empty()) {
    std::vector<std::string> lines;
    for (const std::string& line : diagnostics.lines())
      lines.push_back(without_place(line));
    fail(ErrorKind::asset, "{}", fmt::join(lines, "; "));
  }
  DS_ASSERT(reader.scene.lights.size() == 1 && reader.properties.unused().empty());
  return std::move(reader.scene.lights.front());
}

std::string canonical_lights(const std::vector<Light>& lights) {
  Scene scene;
  scene.lights = lights;
  return canonical_environment(scene);
}

}  // namespace ds

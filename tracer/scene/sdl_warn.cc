// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_warn.h"

#include "tracer/base/log.h"
#include "tracer/scene/scene_reads.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

bool is_bright(Vec3 color) {
  return color.x > 0 || color.y > 0 || color.z > 0;
}

}  // namespace

bool gives_light(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return is_bright(light.color); }) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
           const Material& material = scene.materials[static_cast<std::size_t>(object.material)];
           return material.emits &&
                  (material.emission.texture >= 0 || is_bright(material.emission.constant));
         });
}

bool warn_of_repeats(const PropertySet& properties) {
  for (const RepeatedProperty& repeated : properties.repeated())
    warn(fmt::format("{}: {} stands in line {} already: the last one counts",
                     to_string(repeated.last), repeated.name, repeated.first.line));
  return !properties.repeated().empty();
}

void warn_of_materials(const Scene& scene) {
  for (const Material& material : scene.materials)
    for (const std::string& line : material.unphysical)
      warn(line);
}

bool warn_of_environment(const Scene& environment, const std::string& name) {
  std::vector<std::string> lines;
  for (const Object& object : environment.objects) {
    const std::string& material =
        environment.materials[static_cast<std::size_t>(object.material)].name;
    const MeshExtras reads = reads_of(environment, object.material);
    if (reads.uvs && object.mesh.uvs.empty())
      lines.push_back(fmt::format("{}: object {} has no uv, which its material {} reads", name,
                                  object.name, material));
    if (reads.colors && object.mesh.colors.empty())
      lines.push_back(
          fmt::format("{}: object {} has no colours but white, which its material {} reads", name,
                      object.name, material));
  }
  for (const std::string& line : lines)
    warn(line);
  return !lines.empty();
}

}  // namespace ds

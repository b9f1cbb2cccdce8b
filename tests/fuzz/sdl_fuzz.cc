// SPDX-License-Identifier: Apache-2.0
// LuxCore SDL texts, as a material and as an environment with its film: a scene that can be traced,
// or findings. All but the files that they name, which need a disk; models and images have targets
// of their own.
#include "tracer/base/error.h"
#include "tracer/scene/scene_check.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_prune.h"
#include "tracer/scene/sdl_reader.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace {

constexpr ds::SdlKind k_kinds[] = {ds::SdlKind::texture, ds::SdlKind::material, ds::SdlKind::shape,
                                   ds::SdlKind::object,  ds::SdlKind::light,    ds::SdlKind::film};

/// A scene whose numbers may be out of range, which check_scene says; nothing else may be wrong.
void check(const ds::Scene& scene) {
  try {
    ds::check_scene(scene);
  } catch (const ds::Error& error) {
    DS_ASSERT(error.kind() == ds::ErrorKind::asset);
  }
}

void read_as_material(std::string_view text) {
  ds::Diagnostics findings(ds::ErrorKind::asset);
  ds::SdlReader reader(ds::PropertySet::parse(text, "fuzz.mat", findings), "/nonexistent",
                       findings);
  ds::mend_section_names(reader);
  ds::read_textures(reader);
  ds::read_materials(reader);
  ds::report_unused(reader, std::span(k_kinds).first(2), "a material file");
  if (!findings.empty() || reader.scene.materials.empty()) return;
  const ds::Scene material = ds::prune_to_last_material(std::move(reader.scene));
  DS_ASSERT(!ds::canonical_material(material).empty());
  check(material);
}

void read_as_environment(std::string_view text) {
  ds::Diagnostics findings(ds::ErrorKind::asset);
  ds::SdlReader reader(ds::PropertySet::parse(text, "fuzz.scn", findings), "/nonexistent",
                       findings);
  reader.environment = true;
  ds::mend_section_names(reader);
  ds::read_textures(reader);
  ds::read_materials(reader);
  ds::read_shapes(reader);
  ds::read_objects(reader);
  ds::read_lights(reader);
  reader.scene.tone_map = ds::read_tone_map(reader);
  ds::report_unused(reader, k_kinds, "a scene file");
  if (!findings.empty()) return;
  const ds::Scene environment = ds::prune_environment(std::move(reader.scene));
  DS_ASSERT(!ds::canonical_tone_map(environment.tone_map).empty());
  ds::canonical_environment(environment);
  check(environment);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_as_material(text);
  read_as_environment(text);
  return 0;
}

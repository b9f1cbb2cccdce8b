// SPDX-License-Identifier: Apache-2.0
// A glTF file's materials, or the text of an .mtl file: what can be kept and shown, or an Error(asset). Files that they
// name need a disk; models and images have targets of their own.
#include "tracer/base/error.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mtl_reader.h"
#include "tracer/scene/scene_check.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ds {
extern const MeshFormat k_gltf_format;
}

namespace {

void check(const ds::OwnMaterials& own) {
  DS_ASSERT(ds::own_materials_from_text(ds::own_materials_text(own)) == own);
  for (const auto& [name, count] : own.notes)
    DS_ASSERT(count > 0 && ds::own_note(name) != nullptr);
  ds::OwnMaterials shown = own;
  shown.has_bare = true;
  for (ds::OwnMaterial& material : shown.materials)
    for (auto& [name, input] : material.inputs)
      input.image = -1;
  ds::check_scene(ds::own_scene(shown, true, {}));
}

void read_mtl(std::string_view text) {
  ds::MtlDefinitions defined;
  ds::parse_mtl(text, "/nonexistent/fuzz.mtl", defined);
  ds::OwnMaterials own;
  for (const auto& [name, material] : defined.materials) {
    own.materials.push_back(material.material);
    for (const auto& [input, file] : material.images)
      own.materials.back().inputs[input].image = ds::image_number(own, {file, -1, {}});
    own.notes.insert(material.notes.begin(), material.notes.end());
  }
  check(own);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    if (ds::k_gltf_format.matches(bytes, "/nonexistent/fuzz.gltf")) {
      const ds::OwnMaterials own = ds::k_gltf_format.materials(bytes, "/nonexistent/fuzz.gltf");
      check(own);
      for (const ds::OwnImage& image : own.images)
        if (image.embedded >= 0)
          ds::k_gltf_format.embedded_image(bytes, "/nonexistent/fuzz.gltf", image.embedded);
    } else {
      read_mtl(bytes);
    }
  } catch (const ds::Error& error) {
    DS_ASSERT(error.kind() == ds::ErrorKind::asset);
  }
  return 0;
}

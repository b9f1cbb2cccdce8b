// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/own_materials.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/text_lines.h"
#include "tracer/scene/mesh_formats.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>

namespace ds {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A model's file and the format it is of.
struct ModelBytes {
  std::string bytes;
  const MeshFormat* format = nullptr;

  std::string_view text() const { return without_bom(bytes); }
};

/// Nothing of a format where it is of none: reading it as a model says so.
ModelBytes bytes_of_model(const fs::path& file) {
  ModelBytes model{read_text_file(file)};
  for (const MeshFormat* format : mesh_formats())
    if (model.format == nullptr && format->matches(model.text(), file.string()))
      model.format = format;
  return model;
}

json to_json(const OwnInput& input) {
  return {input.factor.x,
          input.factor.y,
          input.factor.z,
          input.image,
          static_cast<int>(input.channel),
          input.srgb,
          static_cast<int>(input.wrap),
          static_cast<int>(input.filter),
          input.uv_transform};
}

OwnInput input_from(const json& value) {
  OwnInput input;
  input.factor = {value.at(0).get<float>(), value.at(1).get<float>(), value.at(2).get<float>()};
  input.image = value.at(3).get<int>();
  input.channel = static_cast<ImageChannel>(value.at(4).get<int>());
  input.srgb = value.at(5).get<bool>();
  input.wrap = static_cast<ImageWrap>(value.at(6).get<int>());
  input.filter = static_cast<ImageFilter>(value.at(7).get<int>());
  input.uv_transform = value.at(8).get<std::array<float, 6>>();
  return input;
}

// Names are bytes, of whatever encoding: as lists of their values.
json bytes_to_json(const std::string& text) {
  return std::vector<unsigned char>(text.begin(), text.end());
}
std::string bytes_from(const json& value) {
  const auto bytes = value.get<std::vector<unsigned char>>();
  return {bytes.begin(), bytes.end()};
}

json to_json(const OwnMaterial& material) {
  json inputs = json::object();
  for (const auto& [name, input] : material.inputs)
    inputs[name] = to_json(input);
  return {bytes_to_json(material.name), std::move(inputs)};
}

OwnMaterial material_from(const json& value) {
  OwnMaterial material{bytes_from(value.at(0)), {}};
  for (const auto& [name, input] : value.at(1).items())
    material.inputs[name] = input_from(input);
  return material;
}

Hash128 hash_from(const json& value) {
  const auto hash = Hash128::from_hex(value.get<std::string>());
  if (!hash) fail(ErrorKind::io, "wanted a hash of materials, found none");
  return *hash;
}

}  // namespace

const OwnNote* own_note(std::string_view name) {
  const auto* const at = std::find_if(k_own_notes.begin(), k_own_notes.end(),
                                      [&](const OwnNote& note) { return name == note.name; });
  return at == k_own_notes.end() ? nullptr : at;
}

OwnMaterial light_grey() {
  const auto grey = [](float value) { return OwnInput{.factor = {value, value, value}}; };
  return {"", {{"basecolor", grey(0.8F)}, {"roughness", grey(0.5F)}, {"specular", grey(0.5F)}}};
}

int image_number(OwnMaterials& materials, const OwnImage& image) {
  std::vector<OwnImage>& images = materials.images;
  const auto at = std::find(images.begin(), images.end(), image);
  const auto number = static_cast<int>(at - images.begin());
  if (at == images.end()) images.push_back(image);
  return number;
}

std::vector<fs::path> own_material_files(const fs::path& model) {
  const ModelBytes read = bytes_of_model(model);
  if (read.format == nullptr || read.format->material_files == nullptr) return {};
  return read.format->material_files(read.text(), model.string());
}

OwnMaterials read_own_materials(const fs::path& model) {
  const FileMesh mesh = read_model(model).mesh;
  const ModelBytes read = bytes_of_model(model);
  OwnMaterials own;
  own.bare = light_grey();
  if (read.format != nullptr && read.format->materials != nullptr)
    own = read.format->materials(read.text(), model.string());
  own.faces = materials_hash(mesh);
  own.has_bare = mesh.materials.empty() || std::find(mesh.materials.begin(), mesh.materials.end(),
                                                     0U) != mesh.materials.end();
  if (own.has_bare) ++own.notes[k_bare_faces];
  return own;
}

std::string embedded_image(const fs::path& model, int number) {
  const ModelBytes read = bytes_of_model(model);
  if (read.format == nullptr || read.format->embedded_image == nullptr)
    fail(ErrorKind::asset, "{}: wanted a file that holds images, found none", model.string());
  return read.format->embedded_image(read.text(), model.string(), number);
}

std::string own_materials_text(const OwnMaterials& own) {
  json materials = json::array(), images = json::array();
  for (const OwnMaterial& material : own.materials)
    materials.push_back(to_json(material));
  for (const OwnImage& image : own.images)
    images.push_back({bytes_to_json(image.file.native()), image.embedded, image.content.hex()});
  return json{std::move(materials), to_json(own.bare), own.has_bare,
              own.faces.hex(),      std::move(images), own.notes}
      .dump();
}

OwnMaterials own_materials_from_text(std::string_view text) {
  OwnMaterials own;
  try {
    const json all = json::parse(text);
    for (const json& material : all.at(0))
      own.materials.push_back(material_from(material));
    own.bare = material_from(all.at(1));
    own.has_bare = all.at(2).get<bool>();
    own.faces = hash_from(all.at(3));
    for (const json& image : all.at(4))
      own.images.push_back(
          {bytes_from(image.at(0)), image.at(1).get<int>(), hash_from(image.at(2))});
    own.notes = all.at(5).get<std::map<std::string, std::uint64_t>>();
  } catch (const json::exception& error) {
    fail(ErrorKind::io, "wanted materials that were kept: {}", error.what());
  }
  return own;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/build/keys.h"

#include "tracer/base/canonical.h"
#include "tracer/device/program_text.h"
#include "tracer/scene/sdl.h"

#include <span>

namespace ds {
namespace {

/// How each kind of file is encoded. The names stand in the keys: a change of an encoder's settings
/// changes its name here and makes the files anew from what is traced.
struct Encoding {
  const char* kind;
  const char* ending;
  const char* format;
};
constexpr Encoding k_encodings[] = {
    {"image", ".png", "png 8 bit, zlib 6, version 1"},
    {"mask", ".mask.png", "png 8 bit, zlib 6, version 1"},
    {"depth", ".depth.exr", "exr float, zip, version 1"},
};
/// Version of how mask and depth are traced.
constexpr int k_geometry_version = 1;

const Encoding& encoding_of(std::string_view kind) {
  for (const Encoding& encoding : k_encodings)
    if (encoding.kind == kind) return encoding;
  assertion_failed("kind is in k_encodings", __FILE__, __LINE__);
}

const char* name_of(Centring centre) {
  return centre == Centring::none ? "none" : centre == Centring::mass ? "mass" : "box";
}

const char* name_of(Normals normals) {
  return normals == Normals::smooth ? "smooth" : normals == Normals::keep ? "keep" : "flat";
}

void add_vector(CanonicalText& text, std::string_view name, Vec3d v) {
  const double values[] = {v.x, v.y, v.z};
  text.add(name, std::span<const double>(values));
}

/// Stands for the model where only the kinds of effects in a scene matter.
Mesh stand_in() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// What is done to the film and which files there are, for `explain`.
std::string canonical_files(const OutputSettings& outputs, const ToneMap& tone_map) {
  CanonicalText text;
  if (outputs.image) text.add("image", encoding_of("image").format);
  if (outputs.mask) text.add("mask", encoding_of("mask").format);
  if (outputs.depth) text.add("depth", encoding_of("depth").format);
  return text.text() + canonical_tone_map(tone_map);
}

}  // namespace

Scene scene_without_model(Inputs& inputs, const ImageSpec& image) {
  return compose(inputs.environment(image.environment_folder), inputs.material(image.material_file),
                 stand_in());
}

const ToneMap& tone_map_of(const Recipe& recipe, const Scene& environment) {
  return recipe.outputs.tone_map ? *recipe.outputs.tone_map : environment.tone_map;
}

std::string canonical_model(Hash128 geometry, const NormaliseOptions& options) {
  CanonicalText text;
  text.add("geometry", geometry.hex());
  text.add("up", options.up == UpAxis::y ? "y" : "z");
  if (options.size_m != 0) text.add("size_m", options.size_m);
  if (options.place_on_ground) text.add("ground_z_m", options.ground_z_m);
  text.add("centre", name_of(options.centre));
  text.add("normals", name_of(options.normals));
  if (options.normals == Normals::smooth) text.add("crease_deg", options.crease_deg);
  return text.text();
}

std::string output_path(const std::string& image_id, const std::string& kind) {
  return "images/" + image_id + encoding_of(kind).ending;
}

std::vector<std::string> output_paths(const OutputSettings& outputs, const std::string& image_id) {
  std::vector<std::string> paths;
  if (outputs.image) paths.push_back(output_path(image_id, "image"));
  if (outputs.mask) paths.push_back(output_path(image_id, "mask"));
  if (outputs.depth) paths.push_back(output_path(image_id, "depth"));
  return paths;
}

KeyMaker::KeyMaker(const Recipe& recipe, Inputs& inputs, TextSet& texts)
    : recipe_(recipe),
      inputs_(inputs),
      texts_(texts),
      geometry_program_(hash_text(strip_comments(geometry_program_text()))) {}

const Scene& KeyMaker::known_scene(const ImageSpec& image) {
  const SceneName name{image.material_file, image.environment_folder};
  const auto found = scenes_.find(name);
  if (found != scenes_.end()) return found->second;
  return scenes_.emplace(name, scene_without_model(inputs_, image)).first->second;
}

const std::string& KeyMaker::environment_shape(const std::filesystem::path& folder) {
  const auto found = environment_shapes_.find(folder);
  if (found != environment_shapes_.end()) return found->second;
  CanonicalText text;
  for (const Object& object : inputs_.environment(folder).objects) {
    text.add("object.geometry", geometry_hash(object.mesh).hex());
    text.add("object.camera_invisible", object.camera_invisible);
  }
  return environment_shapes_.emplace(folder, text.text()).first->second;
}

Hash128 KeyMaker::geometry_key(const ImageSpec& image, Hash128 model_part) {
  CanonicalText text;
  text.add("version", k_geometry_version);
  text.add("host_version", k_host_render_version);
  text.add("program", geometry_program_.hex());
  text.add("model", model_part.hex());
  text.add("environment", environment_shape(image.environment_folder));
  add_vector(text, "camera.position", image.camera.position);
  add_vector(text, "camera.target", image.camera.target);
  add_vector(text, "camera.up", image.camera.up);
  text.add("camera.fov_deg", image.camera.fov_deg);
  text.add("width", image.engine.width);
  text.add("height", image.engine.height);
  return hash_text(text.text());
}

std::vector<OutputFile> KeyMaker::outputs(const ImageSpec& image, const ImageKeys& keys,
                                          const ToneMap& tone_map) const {
  std::vector<OutputFile> outputs;
  const auto add = [&](const std::string& kind, Hash128 traced, const std::string& development) {
    CanonicalText text;
    text.add("kind", kind);
    text.add("from", traced.hex());
    text.add("format", encoding_of(kind).format);
    outputs.push_back({kind, output_path(image.id, kind), hash_text(text.text() + development)});
  };
  if (recipe_.outputs.image) add("image", keys.render, canonical_tone_map(tone_map));
  if (recipe_.outputs.mask) add("mask", keys.geometry, "");
  if (recipe_.outputs.depth) add("depth", keys.geometry, "");
  return outputs;
}

ImageKeys KeyMaker::keys(const ImageSpec& image) {
  const Scene& environment = inputs_.environment(image.environment_folder);
  const auto part = [&](auto& known, const std::filesystem::path& path, const auto& canonical) {
    const auto found = known.find(path);
    return found != known.end() ? found->second
                                : known.emplace(path, texts_.add(canonical())).first->second;
  };
  const ToneMap& tone_map = tone_map_of(recipe_, environment);
  ImageKeys keys;
  keys.parts[0] =
      texts_.add(canonical_model(inputs_.model_geometry(image.model_file), recipe_.normalise));
  keys.parts[1] = part(material_parts_, image.material_file,
                       [&] { return canonical_material(inputs_.material(image.material_file)); });
  keys.parts[2] = part(environment_parts_, image.environment_folder,
                       [&] { return canonical_environment(environment); });
  keys.parts[3] = texts_.add(canonical_camera(image.camera));
  keys.parts[4] = texts_.add(canonical_engine(known_scene(image), image.camera, image.engine));
  keys.parts[5] = texts_.add(canonical_files(recipe_.outputs, tone_map));

  CanonicalText five;
  for (std::size_t i = 0; i < 5; ++i)
    five.add(k_part_names[i], keys.parts[i].hex());
  keys.render = hash_text(five.text());
  CanonicalText kept;
  kept.add("kind", "film_sums");
  for (std::size_t i = 0; i < 4; ++i)
    kept.add(k_part_names[i], keys.parts[i].hex());
  kept.add(k_part_names[4],
           hash_text(canonical_kept_engine(known_scene(image), image.camera, image.engine)).hex());
  keys.kept = hash_text(kept.text());
  keys.geometry = geometry_key(image, keys.parts[0]);
  keys.outputs = outputs(image, keys, tone_map);

  CanonicalText files;
  for (const OutputFile& output : keys.outputs)
    files.add(output.kind, output.key.hex());
  keys.files = hash_text(files.text());
  return keys;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/program_text.h"

#include "tracer/base/error.h"
#include "tracer/device/texture_code.h"
#include "tracer/kernels/embedded.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <set>
#include <span>

namespace ds {
namespace {

std::string_view embedded_text(std::string_view path) {
  for (const EmbeddedFile& file : std::span(k_embedded_files, k_embedded_file_count))
    if (path == file.path) return file.text;
  fail(ErrorKind::device, "kernel file {} is not part of this program", path);
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  return line;
}

/// What stands behind a directive's '#' and its blanks; nothing of other lines.
std::string_view directive_of(std::string_view line) {
  if (!line.starts_with('#')) return {};
  line.remove_prefix(std::min(line.find_first_not_of(' ', 1), line.size()));
  return line;
}

/// The path of a line `#include "path"`, or nothing.
std::string_view included_path(std::string_view line) {
  constexpr std::string_view k_include = "include \"";
  std::string_view path = directive_of(line);
  if (!path.starts_with(k_include)) return {};
  path.remove_prefix(k_include.size());
  return path.substr(0, path.find('"'));
}

/// Takes the rest of an `#if` with its `#endif` off the text.
void skip_block(std::string_view& text) {
  for (int depth = 1; depth > 0;) {
    DS_ASSERT(!text.empty());
    const std::string_view directive = directive_of(take_line(text));
    DS_ASSERT(depth > 1 || !directive.starts_with("el"));
    depth += directive.starts_with("if") ? 1 : directive.starts_with("endif") ? -1 : 0;
  }
}

/// Puts files together. What stands behind `#ifdef DS_HOOK_...` is in the text only where that is
/// defined, so that a hook is in no key of a program without it.
class Assembly {
 public:
  explicit Assembly(const std::string& definitions) : text_(definitions) {
    for (std::string_view rest = definitions; !rest.empty();) {
      constexpr std::string_view k_define = "#define ";
      std::string_view line = take_line(rest);
      if (!line.starts_with(k_define)) continue;
      line.remove_prefix(k_define.size());
      if (line.starts_with(k_hook)) hooks_.emplace(line);
    }
  }
  void add(std::string_view path) {
    if (!done_.emplace(path).second) return;
    for (std::string_view rest = embedded_text(path); !rest.empty();) {
      const std::string_view line = take_line(rest);
      if (const std::string_view other = included_path(line); !other.empty()) {
        add(other);
      } else if (is_missing_hook(line)) {
        skip_block(rest);
      } else if (!line.starts_with("#pragma once")) {
        text_ += line;
        text_ += '\n';
      }
    }
  }
  std::string take() { return std::move(text_); }

 private:
  static constexpr std::string_view k_hook = "DS_HOOK_";

  bool is_missing_hook(std::string_view line) const {
    constexpr std::string_view k_ifdef = "ifdef ";
    std::string_view name = directive_of(line);
    if (!name.starts_with(k_ifdef)) return false;
    name.remove_prefix(k_ifdef.size());
    return name.starts_with(k_hook) && !hooks_.contains(name);
  }

  std::string text_;
  std::set<std::string, std::less<>> done_, hooks_;
};

/// "#define NAME(X) X(a, 0) X(b, 1)"
std::string list_definition(std::string_view name, const std::vector<std::string>& entries,
                            const std::vector<std::string>& numbers_from) {
  std::string text = fmt::format("#define {}(X)", name);
  for (const std::string& entry : entries)
    text += fmt::format(" X({}, {})", entry, Features::number(numbers_from, entry));
  return text + "\n";
}

/// Of a material: its inputs' and its numbers.
int input_floats(const NodeType& type) {
  int floats = static_cast<int>(type.numbers.size());
  for (const InputType& input : type.inputs)
    floats += input.width;
  return floats;
}

/// Materials that objects show, and the parts of mixes among them.
std::vector<bool> used_materials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const Object& object : scene.objects)
    if (object.material >= 0) used[static_cast<std::size_t>(object.material)] = true;
  // Children stand before their parent, so one pass from the end reaches all.
  for (std::size_t i = scene.materials.size(); i-- > 0;)
    if (used[i])
      for (const int child : scene.materials[i].children)
        if (child >= 0) used[static_cast<std::size_t>(child)] = true;
  return used;
}

/// Those present, with children or without. Keeps the order of the tables, so that equal sets make
/// equal programs.
std::vector<std::string> prefixes(std::span<const NodeType> types, const std::vector<bool>& present,
                                  bool with_children = false) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < types.size(); ++i)
    if (present[i] && (types[i].children > 0) == with_children)
      list.emplace_back(types[i].kernel_prefix);
  return list;
}

/// Of each material.
std::vector<int> chooser_depths(const Scene& scene) {
  std::vector<int> depths(scene.materials.size(), 0);
  // Children stand before their parent.
  for (std::size_t i = 0; i < depths.size(); ++i)
    for (const int child : scene.materials[i].children)
      if (child >= 0) depths[i] = std::max(depths[i], depths[static_cast<std::size_t>(child)] + 1);
  return depths;
}

void add_materials(const Scene& scene, Features& f) {
  const std::vector<int> depths = chooser_depths(scene);
  const std::vector<bool> used = used_materials(scene);
  std::vector<bool> present(material_types().size(), false);
  std::vector<bool> textures(texture_types().size(), false);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Material& material = scene.materials[i];
    const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
    present[static_cast<std::size_t>(material.type)] = true;
    f.material_inputs = std::max(f.material_inputs, input_floats(type));
    f.chooser_depth = std::max(f.chooser_depth, depths[i]);
    const TextureCode code = texture_code(scene, material);
    for (const int texture : code.types)
      textures[static_cast<std::size_t>(texture)] = true;
    f.texture_stack = std::max(f.texture_stack, code.stack);
  }
  f.materials = prefixes(material_types(), present);
  f.choosers = prefixes(material_types(), present, true);
  f.textures = prefixes(texture_types(), textures);
}

/// Whether the model shows a material that casts caustics, itself or as a part.
bool model_casts_caustics(const Scene& scene) {
  const std::vector<bool> casts = materials_with(scene, kernels::k_trait_casts_caustics);
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return object.id == k_model_object_id && object.material >= 0 &&
           casts[static_cast<std::size_t>(object.material)];
  });
}

void add_light(const LightType& type, Features& f) {
  f.lights.emplace_back(type.kernel_prefix);
  if (has_trait(type, kernels::k_trait_beyond)) f.escape_lights.emplace_back(type.kernel_prefix);
}

void add_lights(const Scene& scene, Features& f) {
  std::set<std::string_view> names;
  for (const Light& light : scene.lights)
    if (shines(light)) names.insert(type_of(light).kernel_prefix);
  for (const Object& object : scene.objects)
    if (object.material >= 0 && shines(scene.materials[static_cast<std::size_t>(object.material)]))
      names.insert("mesh");
  for (const LightType& type : light_types())
    if (names.contains(type.kernel_prefix)) add_light(type, f);
}

/// "#define NAME(type) (((type) == 0u) | ((type) == 2u))": whether a point's material, which is no
/// chooser, has the trait. Nothing where none of the program has.
std::string trait_definition(std::string_view name, const Features& f, unsigned trait) {
  std::string any;
  for (const NodeType& type : material_types())
    if (const int number = Features::number(f.materials, type.kernel_prefix);
        number >= 0 && has_trait(type, trait))
      any += fmt::format("{}((type) == {}u)", any.empty() ? "" : " | ", number);
  return any.empty() ? "" : fmt::format("#define {}(type) ({})\n", name, any);
}

/// Whether a material of the program, or a chooser, has the trait.
bool any_material(const Features& f, unsigned trait) {
  return std::any_of(material_types().begin(), material_types().end(), [&](const NodeType& type) {
    return has_trait(type, trait) && f.has_material(type.kernel_prefix);
  });
}

bool any_light(const Features& f, unsigned trait) {
  return std::any_of(f.lights.begin(), f.lights.end(),
                     [&](const std::string& name) { return has_trait(light_type(name), trait); });
}

/// Of materials and textures.
std::string material_list(const Features& f) {
  std::string text = list_definition("DS_MATERIALS", f.materials, f.materials);
  if (f.textures.empty()) return text;
  text += list_definition("DS_TEXTURES", f.textures, f.textures);
  return text + fmt::format("#define DS_TEXTURE_STACK {}\n", f.texture_stack);
}

std::string input_definition(const Features& f) {
  return fmt::format("#define DS_MATERIAL_INPUTS {}\n", f.material_inputs);
}

std::string light_plane_list(const Features& f) {
  if (f.light_planes.empty()) return "";
  return "#define DS_HOOK_LIGHT_PLANES\n" +
         list_definition("DS_LIGHT_PLANES", f.light_planes, f.light_planes) +
         fmt::format("#define DS_LIGHT_PLANE_COUNT {}\n", f.light_planes.size());
}

std::string chooser_list(const Features& f) {
  if (f.choosers.empty()) return "";
  std::vector<std::string> all = f.materials;
  all.insert(all.end(), f.choosers.begin(), f.choosers.end());
  return list_definition("DS_CHOOSERS", f.choosers, all) +
         fmt::format("#define DS_FIRST_CHOOSER {}\n", f.materials.size());
}

}  // namespace

bool samples_lights(const Features& f) {
  return any_light(f, kernels::k_trait_sampled);
}

std::vector<bool> materials_with(const Scene& scene, unsigned traits) {
  std::vector<bool> have(scene.materials.size(), false);
  // Children stand before their parent.
  for (std::size_t i = 0; i < have.size(); ++i) {
    const Material& material = scene.materials[i];
    have[i] = has_trait(material_types()[static_cast<std::size_t>(material.type)], traits);
    for (const int child : material.children)
      if (child >= 0 && have[static_cast<std::size_t>(child)]) have[i] = true;
  }
  return have;
}

bool shines(const Light& light) {
  return light.color.x > 0 || light.color.y > 0 || light.color.z > 0;
}

bool shines(const Material& material) {
  const Vec3 c = material.emission.constant;
  return material.emits && (material.emission.texture >= 0 || c.x > 0 || c.y > 0 || c.z > 0);
}

int Features::number(const std::vector<std::string>& list, std::string_view name) {
  const auto found = std::find(list.begin(), list.end(), name);
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

bool Features::has_material(std::string_view prefix) const {
  return number(materials, prefix) >= 0 || number(choosers, prefix) >= 0;
}

Features features_of(const Scene& scene, const Camera& camera) {
  Features f;
  add_materials(scene, f);
  add_lights(scene, f);
  f.lens = camera.lens_radius_m > 0;
  f.camera_invisible = std::any_of(scene.objects.begin(), scene.objects.end(),
                                   [](const Object& object) { return object.camera_invisible; });
  f.lobe_choice = any_material(f, kernels::k_trait_lobes);
  f.guide = any_light(f, kernels::k_trait_small) && model_casts_caustics(scene) &&
            any_material(f, kernels::k_trait_receives_caustics);
  return f;
}

Features all_features() {
  Features f;
  for (const NodeType& type : material_types()) {
    (type.children > 0 ? f.choosers : f.materials).emplace_back(type.kernel_prefix);
    f.material_inputs = std::max(f.material_inputs, input_floats(type));
  }
  for (const NodeType& type : texture_types())
    f.textures.emplace_back(type.kernel_prefix);
  for (const LightType& type : light_types())
    add_light(type, f);
  f.lens = f.camera_invisible = f.lobe_choice = f.guide = true;
  f.texture_stack = k_texture_stack_limit;
  return f;
}

Features full_features(const Features& own) {
  constexpr int k_usual_depth = 8;  // one program serves all scenes that are not deeper
  Features all = all_features();
  all.chooser_depth = std::max(own.chooser_depth, k_usual_depth);
  return all;
}

std::string assemble(const std::string& definitions, std::span<const std::string> paths) {
  Assembly assembly(definitions);
  for (const std::string& path : paths)
    assembly.add(path);
  return assembly.take();
}

std::string material_definitions(const Features& f) {
  return material_list(f) + input_definition(f) + chooser_list(f) +
         fmt::format("#define DS_CHOOSER_DEPTH {}\n", f.chooser_depth);
}

std::vector<std::string> material_files(const Features& f) {
  std::vector<std::string> paths;
  for (const std::string& name : f.textures)
    paths.push_back(fmt::format("tracer/kernels/textures/{}.h", name));
  for (const auto* list : {&f.materials, &f.choosers})
    for (const std::string& name : *list)
      paths.push_back(fmt::format("tracer/kernels/materials/{}.h", name));
  return paths;
}

std::string path_program_text(const Features& f) {
  std::string head = material_list(f);
  if (!f.lights.empty()) head += list_definition("DS_LIGHTS", f.lights, f.lights);
  if (!f.escape_lights.empty())
    head += list_definition("DS_ESCAPE_LIGHTS", f.escape_lights, f.lights);
  head += input_definition(f);
  // Alone, a constant sky needs no next-event estimation at all.
  if (samples_lights(f)) head += "#define DS_LIGHTS_SAMPLED\n";
  if (Features::number(f.lights, "mesh") >= 0) head += "#define DS_MESH_LIGHTS\n";
  head += chooser_list(f);
  if (f.lens) head += "#define DS_LENS\n";
  if (f.camera_invisible) head += "#define DS_CAMERA_INVISIBLE\n";
  if (f.lobe_choice) head += "#define DS_LOBE_CHOICE\n";
  head += trait_definition("DS_TRANSMITS", f, kernels::k_trait_transmits);
  if (f.guide) head += trait_definition("DS_GUIDED", f, kernels::k_trait_receives_caustics);
  head += light_plane_list(f);

  std::vector<std::string> paths = material_files(f);
  for (const std::string& name : f.lights)
    paths.push_back(fmt::format("tracer/kernels/lights/{}.h", name));
  for (const std::string& name : f.light_planes)
    paths.push_back(fmt::format("tracer/kernels/planes/{}.h", name));
  paths.emplace_back("tracer/kernels/path.cl");
  return assemble(head, paths);
}

std::string rays_program_text() {
  const std::string path = "tracer/kernels/rays.cl";
  return assemble("", std::span(&path, 1));
}

}  // namespace ds

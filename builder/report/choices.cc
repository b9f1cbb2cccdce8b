// SPDX-License-Identifier: Apache-2.0
#include "builder/report/choices.h"

#include "builder/report/texture_mean.h"
#include "tracer/base/error.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <array>

namespace ds {
namespace {

/// Places a texture's mean is taken over: its relative error is below 1 % for the shipped ones.
constexpr int k_mean_points = 4096;

using Choices = std::vector<Choice>;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

void add_effect(Choices& choices, const std::string& name, std::function<void(Subject&)> apply) {
  choices.push_back({k_effect_group, name, 0, true, std::move(apply)});
}

void add_depths(Choices& choices) {
  for (const int depth : {2, 3, 4, 6, 8, 12, k_deepest})
    choices.push_back(
        {k_depth_group, std::to_string(depth), double(depth), false, [depth](Subject& s) {
           s.engine.depth_total = depth;
           s.engine.depth_diffuse = depth;
           s.engine.depth_glossy = depth;
           s.engine.depth_specular = depth;
         }});
}

void add_filters(Choices& choices, const EngineSettings& engine) {
  for (const float width : {0.0f, 1.5f, 2.0f, 3.0f, 4.0f, 6.0f}) {
    if (width == engine.filter_width) continue;
    choices.push_back({k_filter_group, width == 0 ? "box of 1 px" : fmt::format("{} px", width),
                       double{width}, false,
                       [width](Subject& s) { s.engine.filter_width = width; }});
  }
}

const NodeType& type_of(const Material& material) {
  return material_types()[index(material.type)];
}

/// Materials that an object wears, and the parts these are mixed of.
std::vector<bool> worn_materials(const Scene& scene) {
  std::vector<bool> worn(scene.materials.size());
  for (const Object& object : scene.objects)
    if (object.material >= 0) worn[index(object.material)] = true;
  // Children come before the mix that holds them.
  for (std::size_t i = scene.materials.size(); i-- > 0;)
    for (const int child : scene.materials[i].children)
      if (worn[i] && child >= 0) worn[index(child)] = true;
  return worn;
}

void replace_texture(Scene& scene, int texture, Vec3 mean) {
  const auto replace = [&](TextureRef& input) {
    if (input.texture == texture) input = {mean, -1};
  };
  for (Material& material : scene.materials) {
    for (TextureRef& input : material.inputs)
      replace(input);
    replace(material.emission);
  }
}

void add_textures(Choices& choices, const Scene& scene) {
  for (int i = 0; i < static_cast<int>(scene.textures.size()); ++i) {
    const std::optional<Vec3> mean = texture_mean(scene, i, k_mean_points);
    if (!mean) continue;
    add_effect(choices, "texture " + scene.textures[index(i)].name,
               [i, mean](Subject& s) { replace_texture(s.scene, i, *mean); });
  }
}

void add_lights(Choices& choices, const Scene& scene, const std::vector<bool>& worn) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    add_effect(choices, "light " + scene.lights[i].name, [i](Subject& s) {
      s.scene.lights.erase(s.scene.lights.begin() + static_cast<std::ptrdiff_t>(i));
    });
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (worn[i] && scene.materials[i].emits)
      add_effect(choices, "light " + scene.materials[i].name,
                 [i](Subject& s) { s.scene.materials[i].emits = false; });
}

/// The matte material with the base of a glossy one.
Material without_coat(const Material& glossy) {
  Material matte = glossy;
  matte.type = find_type(material_types(), "matte");
  const NodeType& row = type_of(matte);
  matte.inputs.assign(row.inputs.size(), {});
  matte.numbers.clear();
  for (const NumberType& number : row.numbers)
    matte.numbers.push_back(number.default_value);
  for (std::size_t i = 0; i < row.inputs.size(); ++i) {
    const float value = row.inputs[i].default_value;
    matte.inputs[i].constant = {value, value, value};
  }
  matte.inputs[index(find_input(row, "kd"))] =
      glossy.inputs[index(find_input(type_of(glossy), "kd"))];
  return matte;
}

void add_materials(Choices& choices, const Scene& scene, const std::vector<bool>& worn) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!worn[i]) continue;
    const Material& material = scene.materials[i];
    if (type_of(material).name == "glossy2")
      add_effect(choices, "coat of " + material.name,
                 [i](Subject& s) { s.scene.materials[i] = without_coat(s.scene.materials[i]); });
    if (type_of(material).name == "mix")
      add_effect(choices, "mixing of " + material.name, [i](Subject& s) {
        s.scene.materials[i] = s.scene.materials[index(s.scene.materials[i].children[0])];
      });
  }
}

void add_objects(Choices& choices, const Scene& scene) {
  const auto any = [&](const auto& is_so) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), is_so);
  };
  if (any([](const Object& object) { return !object.mesh.normals.empty(); }))
    add_effect(choices, "smooth normals", [](Subject& s) {
      for (Object& object : s.scene.objects)
        object.mesh.normals.clear();
    });
  if (any([](const Object& object) { return object.camera_invisible; }))
    add_effect(choices, "hidden objects", [](Subject& s) {
      for (Object& object : s.scene.objects)
        object.camera_invisible = false;
    });
}

bool shows_filtered_image(const Scene& scene) {
  return std::any_of(scene.textures.begin(), scene.textures.end(), [&](const Texture& texture) {
    return texture.image >= 0 && scene.images[index(texture.image)].filter == ImageFilter::linear;
  });
}

}  // namespace

std::vector<Choice> choices_for(const Subject& subject) {
  Choices choices;
  const bool strict = subject.engine.math == MathMode::strict;
  choices.push_back({k_math_group, strict ? "fast" : "strict", 0, false, [strict](Subject& s) {
                       s.engine.math = strict ? MathMode::fast : MathMode::strict;
                     }});
  add_depths(choices);
  add_filters(choices, subject.engine);
  if (shows_filtered_image(subject.scene))
    choices.push_back({k_texture_filter_group, "nearest texel", 0, true, [](Subject& s) {
                         for (Image& image : s.scene.images)
                           image.filter = ImageFilter::nearest;
                       }});
  const std::vector<bool> worn = worn_materials(subject.scene);
  if (subject.camera.lens_radius_m > 0)
    choices.push_back(
        {k_effect_group, "lens", 0, false, [](Subject& s) { s.camera.lens_radius_m = 0; }});
  add_lights(choices, subject.scene, worn);
  add_textures(choices, subject.scene);
  add_materials(choices, subject.scene, worn);
  add_objects(choices, subject.scene);
  return choices;
}

}  // namespace ds

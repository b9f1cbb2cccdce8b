// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/effect_choices.h"

#include "builder/measure/material_albedo.h"
#include "builder/measure/texture_mean.h"
#include "tracer/base/error.h"
#include "tracer/device/program_text.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <optional>

namespace ds {
namespace {

/// Places a texture's mean is taken over: its relative error is below 1 % for the shipped ones.
constexpr int k_mean_points = 4096;

using Choices = std::vector<Choice>;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

void add(Choices& choices, const std::string& name, std::function<void(Subject&)> apply) {
  choices.push_back({k_effect_group, name, 0, true, std::move(apply)});
}

const NodeType& type_of(const Material& material) {
  return material_types()[index(material.type)];
}

/// Materials that an object wears, and the parts these are mixed of.
std::vector<bool> worn_materials(const Scene& scene) {
  std::vector<bool> worn(scene.materials.size());
  for (const Object& object : scene.objects)
    for (const int material : shown_materials(object))
      worn[index(material)] = true;
  // Children come before the mix that holds them.
  for (std::size_t i = scene.materials.size(); i-- > 0;)
    for (const int child : scene.materials[i].children)
      if (worn[i] && child >= 0) worn[index(child)] = true;
  return worn;
}

void add_lights(Choices& choices, const Scene& scene, const std::vector<bool>& worn) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const std::string name =
        light.name.empty() ? std::string(type_of(light).kernel_prefix) : light.name;
    if (shines(light))
      add(choices, "light " + name, [i](Subject& s) { s.scene.lights[i].color = {}; });
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (worn[i] && shines(scene.materials[i]))
      add(choices, "light " + scene.materials[i].name,
          [i](Subject& s) { s.scene.materials[i].emits = false; });
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
    add(choices, "texture " + scene.textures[index(i)].name,
        [i, mean](Subject& s) { replace_texture(s.scene, i, *mean); });
  }
}

/// What a matte material in place of one without `kd` reflects: the albedo of this one where each
/// textured input is at its mean.
Vec3 matte_colour(const Scene& scene, const Material& material) {
  const NodeType& row = type_of(material);
  Material even = material;
  for (std::size_t i = 0; i < even.inputs.size(); ++i) {
    TextureRef& input = even.inputs[i];
    if (input.texture < 0) continue;
    const float value = row.inputs[i].default_value;
    const std::optional<Vec3> mean = texture_mean(scene, input.texture, k_mean_points);
    input = {mean.value_or(Vec3{value, value, value}), -1};
  }
  return material_albedo(even);
}

/// Keeps what it emits.
Material as_matte(const Material& material, const TextureRef& colour) {
  Material matte = material;
  matte.type = find_type(material_types(), "matte");
  const NodeType& row = type_of(matte);
  DS_ASSERT(row.inputs.size() == 1 && row.numbers.empty());
  matte.inputs = {colour};
  matte.numbers.clear();
  return matte;
}

Material first_part(const Scene& scene, const Material& mix) {
  Material part = scene.materials[index(mix.children[0])];
  part.emits = mix.emits;
  part.emission = mix.emission;
  return part;
}

void add_materials(Choices& choices, const Scene& scene, const std::vector<bool>& worn) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const std::string type(type_of(material).name);
    if (!worn[i] || type == "matte") continue;
    const std::string name = type + " of " + material.name;
    if (type_of(material).children > 0) {
      add(choices, name,
          [i](Subject& s) { s.scene.materials[i] = first_part(s.scene, s.scene.materials[i]); });
      continue;
    }
    // Read when it is applied: its texture may have been left out before.
    const int kd = find_input(type_of(material), "kd");
    if (kd >= 0)
      add(choices, name, [i, kd](Subject& s) {
        Material& m = s.scene.materials[i];
        m = as_matte(m, m.inputs[index(kd)]);
      });
    else
      add(choices, name, [i, colour = matte_colour(scene, material)](Subject& s) {
        s.scene.materials[i] = as_matte(s.scene.materials[i], {colour, -1});
      });
  }
}

void add_objects(Choices& choices, const Scene& scene) {
  const auto any = [&](const auto& is_so) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), is_so);
  };
  if (any([](const Object& object) { return !object.mesh.normals.empty(); }))
    add(choices, "smooth normals", [](Subject& s) {
      for (Object& object : s.scene.objects)
        object.mesh.normals.clear();
    });
  if (any([](const Object& object) { return object.camera_invisible; }))
    add(choices, "hidden objects", [](Subject& s) {
      for (Object& object : s.scene.objects)
        object.camera_invisible = false;
    });
}

/// Every single thing, those that would leave the scene dark among them.
Choices single_choices(const Subject& subject) {
  Choices choices;
  const std::vector<bool> worn = worn_materials(subject.scene);
  if (subject.camera.lens_radius_m > 0)
    choices.push_back(
        {k_effect_group, "lens", 0, false, [](Subject& s) { s.camera.lens_radius_m = 0; }});
  add_lights(choices, subject.scene, worn);
  add_textures(choices, subject.scene);
  add_materials(choices, subject.scene, worn);
  add_objects(choices, subject.scene);
  if (scene_effects(subject.scene, subject.camera).guide)
    add(choices, "guide to caustics", [](Subject& s) {
      for (Object& object : s.scene.objects)
        object.id = 0;  // no model, no guide
    });
  return choices;
}

/// "spot lights", "marble textures", "choice among lobes".
std::string name_of(const Effect& effect) {
  const bool several =
      effect.sort == "light" || effect.sort == "texture" || effect.sort == "material";
  return several ? effect.name + " " + effect.sort + "s" : effect.name;
}

bool is_lit(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return shines(light); }) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
           return object.material >= 0 && shines(scene.materials[index(object.material)]);
         });
}

/// What is left of a subject without some of its single things.
class Leaving {
 public:
  Leaving(const Subject& subject, const Choices& singles) : bare_(subject), singles_(singles) {
    // No effect hangs on the faces of a mesh or on texels, and copies without them cost nothing.
    for (Object& object : bare_.scene.objects)
      object.mesh = {};
    for (Image& image : bare_.scene.images)
      image.rgb = {};
  }

  using Set = std::vector<std::size_t>;  ///< of singles, ascending

  Subject without(const Set& set) const {
    Subject rest = bare_;
    for (const std::size_t i : set)
      singles_[i].apply(rest);
    return rest;
  }
  bool lit(const Set& set) const { return is_lit(without(set).scene); }
  /// One flag an effect, in the order of effects_of.
  std::vector<bool> simulated(const Set& set) const {
    const Subject rest = without(set);
    std::vector<bool> flags;
    for (const Effect& effect : effects_of(rest.scene, rest.camera))
      flags.push_back(effect.simulated);
    return flags;
  }
  /// A set that the effect goes with and no part of which it goes with; nothing where it stays
  /// without all.
  std::optional<Set> least(std::size_t effect) const {
    Set set;
    for (std::size_t i = 0; i < singles_.size(); ++i)
      set.push_back(i);
    if (simulated(set)[effect]) return std::nullopt;
    for (std::size_t i = 0; i < singles_.size(); ++i) {
      Set fewer = set;
      std::erase(fewer, i);
      if (!simulated(fewer)[effect]) set = std::move(fewer);
    }
    return set;
  }

 private:
  Subject bare_;
  const Choices& singles_;
};

std::string why_it_stays(const Effect& effect) {
  if (effect.sort == "material")
    return "other materials are left out by making them this, the simplest";
  DS_ASSERT(effect.sort == "texture");
  return "nothing that shows it has an area to take its mean over";
}

Choice together(const Choices& singles, const Leaving::Set& set, const std::string& name) {
  Choice choice{k_effect_group, name, 0, false, {}};
  std::vector<std::function<void(Subject&)>> steps;
  for (const std::size_t i : set) {
    choice.edits_scene = choice.edits_scene || singles[i].edits_scene;
    steps.push_back(singles[i].apply);
  }
  choice.apply = [steps](Subject& s) {
    for (const auto& step : steps)
      step(s);
  };
  return choice;
}

}  // namespace

EffectChoices effect_choices(const Subject& subject) {
  EffectChoices found;
  const Choices singles = single_choices(subject);
  const Leaving leaving(subject, singles);
  std::vector<std::vector<bool>> simulated;  // of each choice that is offered
  for (std::size_t i = 0; i < singles.size(); ++i) {
    if (!leaving.lit({i})) continue;
    found.choices.push_back(singles[i]);
    simulated.push_back(leaving.simulated({i}));
  }
  const std::vector<Effect> effects = effects_of(subject.scene, subject.camera);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto leaves_it_out = [e](const std::vector<bool>& flags) { return !flags[e]; };
    if (!effects[e].simulated || std::any_of(simulated.begin(), simulated.end(), leaves_it_out))
      continue;
    const std::optional<Leaving::Set> set = leaving.least(e);
    if (!set) {
      found.kept.push_back({effects[e], why_it_stays(effects[e])});
    } else if (!leaving.lit(*set)) {
      found.kept.push_back({effects[e], "without it the scene is dark"});
    } else {
      found.choices.push_back(together(singles, *set, name_of(effects[e])));
      simulated.push_back(leaving.simulated(*set));
    }
  }
  return found;
}

}  // namespace ds

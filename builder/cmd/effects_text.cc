// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/effects_text.h"

#include "builder/plan/image_material.h"
#include "builder/plan/keys.h"
#include "tracer/base/streams.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {

namespace {

bool traces_paths(const OutputSettings& outputs) {
  return outputs.image ||
         std::any_of(outputs.planes.begin(), outputs.planes.end(),
                     [](const PlaneOutput& plane) { return is_of_light(*plane.type); });
}

}  // namespace

std::vector<Effect> image_effects(const Recipe& recipe, Inputs& inputs, const ImageSpec& image) {
  std::vector<Effect> effects =
      effects_of(scene_without_model(recipe, inputs, image), image.camera);
  for (Effect& effect : effects)
    if (!traces_paths(recipe.outputs) && effect.name != "camera-invisible objects") {
      effect.simulated = false;
      effect.why = "no path is traced without outputs.image or a plane of light";
    }
  const auto output = [&](std::string_view name, bool wanted) {
    const bool by_key = name == "image" || name == "mask" || name == "depth";
    const std::string key = by_key ? fmt::format("outputs.{}", name) : "outputs.planes";
    effects.push_back({"output", std::string(name), wanted,
                       by_key ? fmt::format("{} is {}", key, wanted ? "set" : "not set")
                              : fmt::format("{} {} it", key, wanted ? "has" : "lacks")});
  };
  output("image", recipe.outputs.image);
  for (const PlaneType& type : plane_types())
    output(type.name, recipe.outputs.find_plane(type.name) != nullptr);
  return effects;
}

nlohmann::json to_json(const std::vector<Effect>& effects) {
  nlohmann::json array = nlohmann::json::array();
  for (const Effect& effect : effects)
    array.push_back({{"sort", effect.sort},
                     {"name", effect.name},
                     {"simulated", effect.simulated},
                     {"why", effect.why}});
  return array;
}

void print_effects(const std::vector<Effect>& effects) {
  const auto simulated = std::count_if(effects.begin(), effects.end(),
                                       [](const Effect& effect) { return effect.simulated; });
  say(Stream::result, "effects: {} of {} are in this image's program, the rest is left out\n",
      simulated, effects.size());
  for (const bool wanted : {true, false})
    for (const Effect& effect : effects)
      if (effect.simulated == wanted)
        say(Stream::result, "  {:<12} {:<9} {:<28} {}\n", wanted ? "simulated" : "compiled out",
            effect.sort, effect.name, effect.why);
}

}  // namespace ds

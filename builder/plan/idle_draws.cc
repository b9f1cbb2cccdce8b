// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/idle_draws.h"

#include "builder/plan/environment_vary.h"
#include "builder/recipe/keys.h"
#include "tracer/base/error.h"
#include "tracer/base/name_pattern.h"
#include "tracer/device/plane_types.h"
#include "tracer/scene/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Two images of an environment that drew otherwise, of one key.
struct TwoValues {
  const ImageSpec* first = nullptr;
  const ImageSpec* other = nullptr;
};

/// The environment as far as its key's text goes, with little to hash.
Scene without_meshes(const Scene& environment) {
  Scene scene = environment;
  for (Object& object : scene.objects) {
    object.mesh = {};
    object.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    object.mesh.triangles = {{0, 1, 2}};
  }
  return scene;
}

TwoValues two_values(const VaryPattern& vary, const std::vector<const ImageSpec*>& images) {
  TwoValues values{images.front(), nullptr};
  for (const ImageSpec* image : images)
    if (image->variables->draws[vary.drawn] != values.first->variables->draws[vary.drawn])
      values.other = image;
  return values;
}

class IdleDraws {
 public:
  IdleDraws(const Recipe& recipe, const std::vector<PlannedImage>& images, Inputs& inputs);

  Concern find();

 private:
  std::string why_idle(std::size_t drawn);
  std::string why_vary_is_idle(const VaryPattern& vary);
  bool moves_scene(const VaryPattern& vary, const TwoValues& values);

  const Recipe& recipe_;
  Inputs& inputs_;
  /// By environment; their paths are long, and images many.
  std::map<const void*, std::vector<const ImageSpec*>> shown_;
  bool shines_ = false, turns_ = false, pictures_ = false, colours_ = false;
};

IdleDraws::IdleDraws(const Recipe& recipe, const std::vector<PlannedImage>& images, Inputs& inputs)
    : recipe_(recipe), inputs_(inputs), pictures_(recipe.outputs.image) {
  constexpr std::size_t k_most_looks = 64;  // two that drew otherwise are among so many
  for (const PlannedImage& image : images) {
    if (image.error) continue;
    auto& of_environment = shown_[image.spec.environment_folder.identity()];
    if (of_environment.size() < k_most_looks) of_environment.push_back(&image.spec);
  }
  for (const auto& [environment, specs] : shown_) {
    const EnvironmentFacts& facts = inputs.environment_facts(specs.front()->environment_folder);
    shines_ = shines_ || !facts.dark || !recipe.environment_vary.empty();
    turns_ = turns_ || facts.turns;
  }
  for (const PlaneOutput& plane : recipe.outputs.planes) {
    pictures_ = pictures_ || is_of_light(*plane.type);
    colours_ = colours_ || reads_materials(*plane.type);
  }
}

/// Whether the other image's value makes another scene of the first one's.
bool IdleDraws::moves_scene(const VaryPattern& vary, const TwoValues& values) {
  ImageSpec changed = *values.first;
  ImageVariables variables = *changed.variables;
  variables.draws[vary.drawn] = values.other->variables->draws[vary.drawn];
  changed.variables = std::move(variables);
  const fs::path& folder = values.first->environment_folder;
  const EnvironmentFacts& facts = inputs_.environment_facts(folder);
  const std::vector<NodeValue> before = environment_values(*values.first, recipe_, inputs_),
                               after = environment_values(changed, recipe_, inputs_);
  const std::string question =
      "moves " + hash_text(facts.text + facts.nodes + canonical_values(before, ValuesOf::all) +
                           "->" + canonical_values(after, ValuesOf::all))
                     .hex();
  if (const auto known = inputs_.find_known(question)) return *known == "yes";
  const Scene base = without_meshes(inputs_.environment(folder));
  const auto text = [&](const std::vector<NodeValue>& with) {
    return canonical_environment(with_node_values(base, facts.nodes, folder, with));
  };
  const bool moves = text(before) != text(after);
  inputs_.keep_known(question, moves ? "yes" : "no");
  return moves;
}

std::string IdleDraws::why_vary_is_idle(const VaryPattern& vary) {
  bool any = false;
  for (const auto& [environment, images] : shown_) {
    const fs::path& folder = images.front()->environment_folder;
    if (!fits_pattern(environment_name(folder), vary.environment) ||
        inputs_.environment_fits(folder, vary.node, vary.property).empty())
      continue;
    const TwoValues values = two_values(vary, images);
    try {
      // Of one value nothing is told.
      if (values.other == nullptr || moves_scene(vary, values)) return "";
      any = true;
    } catch (const DamagedDatabase&) {
      throw;
    } catch (const Error&) {  // values that do not go together fail their own images
      return "";
    }
  }
  return any ? "without effect beside what else its thing has"
             : "no image shows an environment that has it";
}

std::string IdleDraws::why_idle(std::size_t drawn) {
  const std::string& key = recipe_.drawn[drawn].key;
  if (!shines_ && (key == "environments.gain" || key == "environments.temperature_k"))
    return "no environment has light";
  if (!turns_ && key == "environments.turn_deg") return "environments are alike from all sides";
  if (!recipe_.outputs.image && key.starts_with("outputs.camera.")) return "no picture is made";
  const KeySpec* spec = find_key(key);
  const bool of_film = spec != nullptr              ? spec->moves == Moves::film
                       : key.starts_with("lights[") ? recipe_.keep.clearance_m == 0
                                                    : !colours_;
  if (!pictures_ && of_film) return "no picture is made";
  for (const VaryPattern& vary : recipe_.environment_vary)
    if (vary.drawn == drawn) return why_vary_is_idle(vary);
  return "";
}

Concern IdleDraws::find() {
  Concern concern{"draws_idle", 0, recipe_.drawn.size(), {}};
  if (shown_.empty()) return concern;
  for (std::size_t i = 0; i < recipe_.drawn.size(); ++i)
    if (const std::string why = why_idle(i); !why.empty())
      add_example(concern, fmt::format("{} ({})", recipe_.drawn[i].key, why));
  return concern;
}

}  // namespace

Concern find_idle_draws(const Recipe& recipe, const std::vector<PlannedImage>& images,
                        Inputs& inputs) {
  if (recipe.drawn.empty()) return {"draws_idle", 0, 0, {}};
  return IdleDraws(recipe, images, inputs).find();
}

}  // namespace ds

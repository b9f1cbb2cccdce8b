// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/distractors.h"

#include "builder/recipe/assets.h"
#include "builder/recipe/balanced.h"
#include "builder/recipe/recipe.h"
#include "builder/recipe/settings.h"
#include "builder/recipe/splits.h"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace ds {
namespace {

constexpr std::string_view k_section = "distractors.";
constexpr std::string_view k_their_count = "distractors.count", k_its_place = "distractors.place_m";

// What a choice is for. Part of every dataset made: never change a text.
constexpr std::string_view k_for_distractor = "distractor";
constexpr std::string_view k_for_its_material = "distractor material";

std::vector<DistractorModel> own_models(const Recipe& recipe) {
  const Splits splits(recipe);
  std::vector<DistractorModel> models;
  for (const ModelFile& model : recipe.models) {
    const ModelLabel label = splits.of_model(model.name);
    DistractorModel& one = models.emplace_back();
    one.name = model.name;
    one.file = model.file;
    one.class_path = label.class_path;
    one.split = label.split;
    if (keeps_models_whole(recipe.split.by))
      one.fold = splits.fold(label.split,
                             recipe.split.by == SplitBy::model ? model.name : label.class_path);
  }
  return models;
}

std::vector<DistractorModel> other_models(Settings& settings) {
  const Shared<std::string> class_path = settings.text("distractors.class");
  std::vector<DistractorModel> models;
  for (const ModelFile& model : find_distractors(settings)) {
    DistractorModel& one = models.emplace_back();
    one.name = model.name;
    one.file = model.file;
    one.class_path = class_path;
  }
  return models;
}

void check_class(const Settings& settings, const Recipe& recipe) {
  const std::string& path = settings.text("distractors.class");
  if (path.empty()) return;
  if (!is_class_path(path))
    settings.complain("distractors.class",
                      fmt::format("must be a class path as vehicle/car, got {:?}", path));
  else if (recipe.labels.size() == 0 && settings.diagnostics().empty())
    settings.complain("distractors.class",
                      "wants classes of the models beside it: classes.from names them");
}

DrawnFor drawn_for(const ImageSpec& image, const Recipe& recipe) {
  std::uint64_t view = 0;
  const std::string& name = *image.view;
  std::from_chars(name.data(), name.data() + name.size(), view);
  return {recipe.seed, *image.model_name, name, view, image.variables->attempts};
}

bool may_show(const ImageSpec& image, const Recipe& recipe, const DistractorModel& model) {
  if (!recipe.distractors.of_recipe || !keeps_models_whole(recipe.split.by)) return true;
  return model.split == *image.split && model.fold == image.fold;
}

void draw_one(Distractor& distractor, std::size_t which, const Recipe& recipe, DrawnFor of) {
  const Drawn& drawn = recipe.distractors.drawn[which];
  if (drawn.distribution.per != DrawnPer::view && drawn.key != k_its_place) of.attempt = 0;
  const std::string key =
      distractor_key(distractor.number, std::string_view(drawn.key).substr(k_section.size()));
  const DrawnValue value = draw(drawn.distribution, key, of);
  distractor.draws[which] = value;
  if (drawn.at != nullptr)
    std::copy_n(value.begin(), width_of(drawn.distribution.kind), drawn.at(distractor.values));
}

}  // namespace

std::string distractor_key(int number, std::string_view name) {
  return fmt::format("distractors[{}].{}", number, name);
}

std::vector<Drawn> take_draws_of_each(std::vector<Drawn>& drawn) {
  std::vector<Drawn> taken;
  const auto of_each = std::stable_partition(drawn.begin(), drawn.end(), [](const Drawn& one) {
    return one.key == k_their_count || !one.key.starts_with(k_section);
  });
  std::move(of_each, drawn.end(), std::back_inserter(taken));
  drawn.erase(of_each, drawn.end());
  return taken;
}

void read_distractors(Settings& settings, Recipe& recipe) {
  DistractorSettings& distractors = recipe.distractors;
  const RecipeValue* dir = settings.find("distractors.dir");
  if (dir->text() == nullptr) return;
  distractors.gap_m = settings.number("distractors.gap_m");
  distractors.tries = settings.integer("distractors.tries");
  distractors.own = settings.boolean("distractors.own");
  distractors.of_recipe = *dir->text() == k_recipe_models;
  if (!settings.given(k_its_place) && !settings.misspelt(k_its_place))
    settings.complain(k_its_place,
                      "must be given with distractors.dir: a distribution, as "
                      "{ disc = [0.1, 0.3] }");
  else if (settings.find(k_its_place) != nullptr && settings.distribution(k_its_place) == nullptr &&
           !settings.wrong(k_its_place))
    settings.complain(k_its_place, "must be a distribution: two things cannot stand in one place");
  if (!distractors.of_recipe) distractors.folder = settings.resolve(*dir).filename().string();
  check_class(settings, recipe);
  distractors.models = distractors.of_recipe ? own_models(recipe) : other_models(settings);
}

std::vector<Distractor> draw_distractors(
    const ImageSpec& image, const Recipe& recipe,
    const std::function<bool(const DistractorModel&)>& is_own) {
  const auto count = static_cast<int>(image.variables->values.distractor_count);
  std::vector<Distractor> shown;
  if (recipe.distractors.models.empty() || count == 0) return shown;
  std::vector<const DistractorModel*> models;
  std::vector<std::string> names, materials;
  for (const DistractorModel& model : recipe.distractors.models) {
    if (!may_show(image, recipe, model)) continue;
    models.push_back(&model);
    names.push_back(*model.name);
  }
  if (models.empty()) return shown;
  for (const auto& file : recipe.materials)
    materials.push_back(material_name(file));
  const auto passed_over = [&](const DistractorModel& model) {
    return !recipe.distractors.own &&
           (*model.file == *image.model_file || (is_own != nullptr && is_own(model)));
  };
  const DrawnFor of = drawn_for(image, recipe);
  std::vector<bool> allowed(models.size(), true);
  for (int number = 0; number < count; ++number) {
    const auto chosen = [&](std::string_view what, const std::vector<std::string>& candidates,
                            const std::vector<bool>& among) {
      return highest_hash(recipe.seed, fmt::format("{} {}", what, number),
                          {*image.model_name, *image.view}, candidates, among);
    };
    std::size_t model = chosen(k_for_distractor, names, {});
    while (passed_over(*models[model])) {
      allowed[model] = false;
      if (std::find(allowed.begin(), allowed.end(), true) == allowed.end()) return shown;
      model = chosen(k_for_distractor, names, allowed);
    }
    Distractor& one = shown.emplace_back();
    one.number = number;
    one.model = *models[model];
    if (recipe.assign_materials == Assign::own) {
      one.material_file = one.model.file;
      one.material_name = std::string(k_own_materials);
    } else {
      const std::size_t material = chosen(k_for_its_material, materials, {});
      one.material_file = recipe.materials[material];
      one.material_name = materials[material];
    }
    one.values = recipe.constants;
    one.draws.resize(recipe.distractors.drawn.size());
    for (std::size_t i = 0; i < one.draws.size(); ++i)
      if (recipe.distractors.drawn[i].key != k_its_place) draw_one(one, i, recipe, of);
  }
  return shown;
}

void draw_place(Distractor& distractor, const ImageSpec& image, const Recipe& recipe, int tries) {
  DrawnFor of = drawn_for(image, recipe);
  of.attempt = of.attempt * recipe.distractors.tries + tries;
  distractor.tries = tries;
  for (std::size_t i = 0; i < distractor.draws.size(); ++i)
    if (recipe.distractors.drawn[i].key == k_its_place) draw_one(distractor, i, recipe, of);
}

NormaliseOptions normalise_of(const Distractor& distractor, const Recipe& recipe) {
  NormaliseOptions options = recipe.normalise;
  options.size_m = distractor.values.distractor_size_m;
  options.turn = distractor.values.distractor_turn;
  options.place_m = distractor.values.distractor_place_m;
  return options;
}

}  // namespace ds

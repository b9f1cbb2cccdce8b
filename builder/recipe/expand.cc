// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/balanced.h"
#include "builder/recipe/recipe.h"
#include "builder/recipe/seeded_hash.h"
#include "builder/recipe/splits.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// What a random number is for, so that no two choices share one. Part of every dataset made: never
/// change a text.
constexpr std::string_view k_for_material = "material";
constexpr std::string_view k_for_environment = "environment";
constexpr std::string_view k_for_image = "image";

/// How one of the two axes, material or environment, is assigned.
struct Axis {
  std::string_view purpose;
  const std::vector<fs::path>& candidates;
  std::string (*name)(const fs::path&);
  Assign assign;
  ChoosePer per;
};

/// What an axis gives an image: the file and its name.
struct Asset {
  Shared<fs::path> path;
  Shared<std::string> name;
};

std::uint64_t view_number(std::string_view name) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  DS_ASSERT(error == std::errc() && end == name.data() + name.size());
  return number;
}

/// What one axis gives each view of a model: what is of the model is asked once for all its views.
class Choice {
 public:
  Choice(const Recipe& recipe, const Axis& axis, const Splits& splits)
      : recipe_(recipe), axis_(axis) {
    for (const fs::path& path : axis.candidates) {
      names_.push_back(axis.name(path));
      assets_.push_back({path, names_.back()});
    }
    if (axis.assign == Assign::balanced && !assets_.empty()) balance(splits);
    if (axis.assign != Assign::cycle) return;
    for (const std::string& view : recipe.view_names)
      view_numbers_.push_back(view_number(view));
  }

  void start_model(const std::string& model);
  /// The assets that view number `view` of the model is made with.
  std::span<const Asset> of_view(std::size_t view) const;

 private:
  void balance(const Splits& splits);
  std::size_t chosen(const std::string& view) const;

  const Recipe& recipe_;
  Axis axis_;
  std::vector<std::string> names_;
  std::vector<Asset> assets_;
  std::vector<std::uint64_t> view_numbers_;  ///< where they cycle
  /// By model and view, "" for all views, where they are balanced.
  std::map<std::pair<std::string, std::string>, std::size_t> balanced_;
  std::string model_;
  std::uint64_t start_ = 0;   ///< of the cycle
  std::size_t of_model_ = 0;  ///< chosen for all views
};

void Choice::balance(const Splits& splits) {
  std::map<std::pair<std::string, std::string>, std::vector<Chooser>> groups;  // class, split
  for (const ModelFile& model : recipe_.models) {
    const ModelLabel label = splits.of_model(model.name);
    std::vector<Chooser>& group = groups[{label.class_path, label.split}];
    if (axis_.per == ChoosePer::model)
      group.push_back({model.name, ""});
    else
      for (const std::string& view : recipe_.view_names)
        group.push_back({model.name, view});
  }
  for (const auto& [label, group] : groups) {
    const auto choices = choose_balanced(recipe_.seed, axis_.purpose, group, names_);
    for (std::size_t i = 0; i < group.size(); ++i)
      balanced_.try_emplace({group[i].model, group[i].view}, choices[i]);
  }
}

/// `view` is "" for all of them.
std::size_t Choice::chosen(const std::string& view) const {
  return axis_.assign == Assign::balanced
             ? balanced_.at({model_, view})
             : highest_hash(recipe_.seed, axis_.purpose, {model_, view}, names_);
}

void Choice::start_model(const std::string& model) {
  model_ = model;
  if (assets_.empty()) return;
  if (axis_.assign == Assign::cycle)
    start_ = seeded_hash(recipe_.seed, axis_.purpose, {model_});
  else if (axis_.assign != Assign::all && axis_.per == ChoosePer::model)
    of_model_ = chosen("");
}

std::span<const Asset> Choice::of_view(std::size_t view) const {
  if (axis_.assign == Assign::all || assets_.empty()) return assets_;
  if (axis_.assign == Assign::cycle) {
    // The view's own number, not its place in the list: camera.views leaves the others as they are.
    const std::size_t count = assets_.size();
    return std::span(assets_).subspan((start_ % count + view_numbers_[view]) % count, 1);
  }
  const std::size_t number =
      axis_.per == ChoosePer::model ? of_model_ : chosen(recipe_.view_names[view]);
  return std::span(assets_).subspan(number, 1);
}

bool draws_camera(const Recipe& recipe) {
  return std::any_of(recipe.drawn.begin(), recipe.drawn.end(),
                     [](const Drawn& one) { return one.key.starts_with("camera."); });
}

ImageVariables drawn_for(const Recipe& recipe, const std::string& model, const std::string& view,
                         int attempts) {
  ImageVariables image;
  image.values = recipe.constants;
  image.attempts = attempts;
  const DrawnFor of{recipe.seed, model, view, view_number(view), attempts};
  draw_all(recipe.drawn, of, image.values, image.draws);
  return image;
}

std::map<std::string, std::string> other_classes_of(const Recipe& recipe,
                                                    const std::string& model) {
  std::map<std::string, std::string> classes;
  for (const auto& [name, labels] : recipe.hierarchies)
    classes.emplace(name, labels.find(model).value_or(ModelLabel{}).class_path);
  return classes;
}

/// Split and fold of an image whose other fields stand.
void label_image(ImageSpec& image, const Splits& splits, SplitBy by, const ModelLabel& label) {
  const std::string& thing = split_thing(image, by);
  if (!keeps_models_whole(by)) image.split = splits.of_image(label, thing);
  image.fold = splits.fold(image.split, thing);
}

/// What stands behind model and view in an id.
std::string suffix(const Recipe& recipe, const std::string& material,
                   const std::string& environment) {
  std::string text;
  if (recipe.assign_materials == Assign::all) text += "-" + material;
  if (recipe.assign_environments == Assign::all) text += "-" + environment;
  return text;
}

}  // namespace

NormaliseOptions normalise_of(const ImageSpec& image, const Recipe& recipe) {
  NormaliseOptions options = recipe.normalise;
  const Variables& values = image.variables->values;
  options.size_m = values.model_size_m;
  options.turn = values.model_turn;
  options.place_m = values.model_place_m;
  return options;
}

void fit_image(ImageSpec& image, const Recipe& recipe, const Sphere& model) {
  if (!recipe.camera_fit) return;
  image.camera =
      fit_camera(image.camera, *recipe.camera_fit, model, image.engine.width, image.engine.height);
}

bool draws_views(const Recipe& recipe) {
  return !recipe.distractors.models.empty() ||
         std::any_of(recipe.drawn.begin(), recipe.drawn.end(),
                     [](const Drawn& one) { return one.distribution.per == DrawnPer::view; });
}

void draw_again(ImageSpec& image, const Recipe& recipe, int attempts) {
  image.variables = drawn_for(recipe, image.model_name, image.view, attempts);
  if (draws_camera(recipe))
    image.camera = camera_of(recipe.camera_set, image.variables->values, view_number(*image.view));
}

void check_drawn(const ImageSpec& image, const Recipe& recipe) {
  if (!draws_camera(recipe)) return;
  if (const auto fault = fault_of(recipe.camera_set, image.camera, *image.view))
    fail(ErrorKind::recipe, "{}: {} {}", image.id, fault->key, fault->message);
}

ClassIds class_ids(const Recipe& recipe, const std::set<std::string>& paths) {
  ClassIds ids;
  for (const std::string& path : recipe.class_ids)
    ids.try_emplace(path, ids.size());
  for (const std::string& path : paths)
    if (!path.empty()) ids.try_emplace(path, ids.size());
  return ids;
}

std::string material_name(const fs::path& file) {
  return file.stem().string();
}
std::string environment_name(const fs::path& folder) {
  return folder.filename().string();
}

void expand(const Recipe& recipe, const std::function<void(ImageSpec&&)>& visit) {
  DS_ASSERT(recipe.cameras.size() == recipe.view_names.size());
  check_ids(recipe);
  const Axis materials{k_for_material, recipe.materials, material_name, recipe.assign_materials,
                       recipe.materials_per};
  const Axis environments{k_for_environment, recipe.environments, environment_name,
                          recipe.assign_environments, recipe.environments_per};
  const Splits splits(recipe);
  Choice material_choice(recipe, materials, splits);
  Choice environment_choice(recipe, environments, splits);
  const std::vector<Shared<std::string>> views(recipe.view_names.begin(), recipe.view_names.end());
  std::vector<const ModelFile*> models;
  for (const ModelFile& model : recipe.models)
    models.push_back(&model);
  std::stable_sort(models.begin(), models.end(),
                   [](const auto* a, const auto* b) { return a->name < b->name; });
  ImageSpec image;
  image.engine = recipe.engine;
  image.variables = ImageVariables{recipe.constants, {}, 0};
  const Shared<std::string> own_name{std::string(k_own_materials)};
  for (const ModelFile* model : models) {
    const std::string& name = model->name;
    const ModelLabel label = splits.of_model(name);
    image.model_file = model->file;
    image.model_name = name;
    image.class_path = label.class_path;
    image.split = label.split;  // kept for all images of the model, where it is theirs
    if (!recipe.hierarchies.empty()) image.other_classes = other_classes_of(recipe, name);
    material_choice.start_model(name);
    environment_choice.start_model(name);
    for (std::size_t view = 0; view < recipe.cameras.size(); ++view) {
      image.view = views[view];
      image.camera = recipe.cameras[view];
      if (!recipe.drawn.empty()) draw_again(image, recipe, 0);
      const std::span<const Asset> places = environment_choice.of_view(view);
      const Asset own{image.model_file, own_name};
      for (const Asset& material : recipe.assign_materials == Assign::own
                                       ? std::span(&own, 1)
                                       : material_choice.of_view(view)) {
        image.material_file = material.path;
        image.material_name = material.name;
        for (const Asset& place : places) {
          image.environment_folder = place.path;
          image.environment_name = place.name;
          image.id = name + "/" + *image.view;
          image.id += suffix(recipe, image.material_name, image.environment_name);
          label_image(image, splits, recipe.split.by, label);
          image.engine.seed = top_53_bits(seeded_hash(recipe.seed, k_for_image, {image.id}));
          visit(ImageSpec(image));
        }
      }
    }
  }
}

std::vector<ImageSpec> expand(const Recipe& recipe) {
  std::vector<ImageSpec> images;
  expand(recipe, [&](ImageSpec&& image) { images.push_back(std::move(image)); });
  return images;
}

std::size_t image_count(const Recipe& recipe) {
  const auto each = [](Assign assign, const std::vector<fs::path>& candidates) {
    if (assign == Assign::own) return std::size_t{1};
    return assign == Assign::all ? candidates.size() : std::min<std::size_t>(candidates.size(), 1);
  };
  return recipe.models.size() * recipe.cameras.size() *
         each(recipe.assign_materials, recipe.materials) *
         each(recipe.assign_environments, recipe.environments);
}

void check_ids(const Recipe& recipe) {
  if (recipe.view_names.empty()) return;
  const auto refuse = [&](const std::string& model, const std::string& text) {
    fail(ErrorKind::recipe, "two images would have one name: {}/{}{}", model,
         recipe.view_names.front(), text);
  };
  std::set<std::string> models;
  for (const ModelFile& model : recipe.models)
    if (!models.insert(model.name).second) refuse(model.name, "");
  // Where one axis is "all", its names tell apart what it adds; of two, "a-b" and "c" read like "a"
  // and "b-c".
  if (recipe.assign_materials != Assign::all || recipe.assign_environments != Assign::all) return;
  std::set<std::string> suffixes;
  for (const fs::path& material : recipe.materials)
    for (const fs::path& environment : recipe.environments) {
      const std::string text =
          suffix(recipe, material_name(material), environment_name(environment));
      if (!suffixes.insert(text).second && !models.empty()) refuse(*models.begin(), text);
    }
}

}  // namespace ds

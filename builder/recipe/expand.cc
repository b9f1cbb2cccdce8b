// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"

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
constexpr std::string_view k_for_split = "split";
constexpr std::string_view k_for_material = "material";
constexpr std::string_view k_for_environment = "environment";
constexpr std::string_view k_for_image = "image";

/// 64 bits that depend on the seed, the purpose and the words, each delimited so that ("ab", "c")
/// is not ("a", "bc").
std::uint64_t seeded_hash(std::uint64_t seed, std::string_view purpose,
                          std::initializer_list<std::string_view> words) {
  std::string text = fmt::format_int(seed).str();
  (text += '\n') += purpose;
  for (const std::string_view word : words) {
    const fmt::format_int size(word.size());
    (text += '\n').append(size.data(), size.size());
    (text += ' ') += word;
  }
  return hash64_text(text);
}

/// The highest 53 bits: what a double, and so every JSON reader, holds exactly.
std::uint64_t top_53_bits(std::uint64_t hash) {
  return hash >> 11;
}

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
  Choice(const Recipe& recipe, const Axis& axis) : recipe_(recipe), axis_(axis) {
    for (const fs::path& path : axis.candidates)
      assets_.push_back({path, axis.name(path)});
    if (axis.assign != Assign::cycle) return;
    for (const std::string& view : recipe.view_names)
      view_numbers_.push_back(view_number(view));
  }

  void start_model(const std::string& model);
  /// The assets that view number `view` of the model is made with.
  std::span<const Asset> of_view(std::size_t view) const;

 private:
  std::size_t highest_hash(std::string_view view) const;

  const Recipe& recipe_;
  Axis axis_;
  std::vector<Asset> assets_;
  std::vector<std::uint64_t> view_numbers_;  ///< where they cycle
  std::string model_;
  std::uint64_t start_ = 0;   ///< of the cycle
  std::size_t of_model_ = 0;  ///< chosen for all views
};

std::size_t Choice::highest_hash(std::string_view view) const {
  std::size_t best = 0;
  std::uint64_t highest = 0;
  for (std::size_t i = 0; i < assets_.size(); ++i) {
    const std::string_view name = *assets_[i].name;
    const std::uint64_t hash = axis_.per == ChoosePer::model
                                   ? seeded_hash(recipe_.seed, axis_.purpose, {model_, name})
                                   : seeded_hash(recipe_.seed, axis_.purpose, {model_, view, name});
    if (i == 0 || hash > highest) {
      best = i;
      highest = hash;
    }
  }
  return best;
}

void Choice::start_model(const std::string& model) {
  model_ = model;
  if (axis_.assign == Assign::cycle)
    start_ = seeded_hash(recipe_.seed, axis_.purpose, {model_});
  else if (axis_.assign == Assign::random && axis_.per == ChoosePer::model)
    of_model_ = highest_hash({});
}

std::span<const Asset> Choice::of_view(std::size_t view) const {
  if (axis_.assign == Assign::all || assets_.empty()) return assets_;
  if (axis_.assign == Assign::cycle) {
    // The view's own number, not its place in the list: camera.views leaves the others as they are.
    const std::size_t count = assets_.size();
    return std::span(assets_).subspan((start_ % count + view_numbers_[view]) % count, 1);
  }
  const std::size_t chosen =
      axis_.per == ChoosePer::model ? of_model_ : highest_hash(recipe_.view_names[view]);
  return std::span(assets_).subspan(chosen, 1);
}

ModelLabel label_of(const Recipe& recipe, const std::string& model) {
  const ModelLabel label = recipe.labels.find(model).value_or(ModelLabel{});
  if (!recipe.split_test_fraction) return label;
  const double share =
      static_cast<double>(top_53_bits(seeded_hash(recipe.seed, k_for_split, {model}))) * 0x1p-53;
  return {label.class_path, share < *recipe.split_test_fraction ? "test" : "train"};
}

std::map<std::string, std::string> other_classes_of(const Recipe& recipe,
                                                    const std::string& model) {
  std::map<std::string, std::string> classes;
  for (const auto& [name, labels] : recipe.hierarchies)
    classes.emplace(name, labels.find(model).value_or(ModelLabel{}).class_path);
  return classes;
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

void fit_image(ImageSpec& image, const Recipe& recipe, const Sphere& model) {
  if (!recipe.camera_fit) return;
  image.camera =
      fit_camera(image.camera, *recipe.camera_fit, model, image.engine.width, image.engine.height);
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
  Choice material_choice(recipe, materials), environment_choice(recipe, environments);
  const std::vector<Shared<std::string>> views(recipe.view_names.begin(), recipe.view_names.end());
  std::vector<const ModelFile*> models;
  for (const ModelFile& model : recipe.models)
    models.push_back(&model);
  std::stable_sort(models.begin(), models.end(),
                   [](const auto* a, const auto* b) { return a->name < b->name; });
  ImageSpec image;
  image.engine = recipe.engine;
  for (const ModelFile* model : models) {
    const std::string& name = model->name;
    const ModelLabel label = label_of(recipe, name);
    image.model_file = model->file;
    image.model_name = name;
    image.class_path = label.class_path;
    image.split = label.split;
    if (!recipe.hierarchies.empty()) image.other_classes = other_classes_of(recipe, name);
    material_choice.start_model(name);
    environment_choice.start_model(name);
    for (std::size_t view = 0; view < recipe.cameras.size(); ++view) {
      image.view = views[view];
      image.camera = recipe.cameras[view];
      const std::span<const Asset> places = environment_choice.of_view(view);
      for (const Asset& material : material_choice.of_view(view)) {
        image.material_file = material.path;
        image.material_name = material.name;
        for (const Asset& place : places) {
          image.environment_folder = place.path;
          image.environment_name = place.name;
          image.id = name + "/" + *image.view;
          image.id += suffix(recipe, image.material_name, image.environment_name);
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

// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"

#include <algorithm>
#include <charconv>
#include <set>

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
  std::string text = fmt::format("{}\n{}", seed, purpose);
  for (const std::string_view word : words)
    text += fmt::format("\n{} {}", word.size(), word);
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

std::size_t highest_hash(const Recipe& recipe, const Axis& axis, std::string_view model,
                         std::string_view view) {
  std::size_t best = 0;
  std::uint64_t highest = 0;
  for (std::size_t i = 0; i < axis.candidates.size(); ++i) {
    const std::string name = axis.name(axis.candidates[i]);
    const std::uint64_t hash = axis.per == ChoosePer::model
                                   ? seeded_hash(recipe.seed, axis.purpose, {model, name})
                                   : seeded_hash(recipe.seed, axis.purpose, {model, view, name});
    if (i == 0 || hash > highest) {
      best = i;
      highest = hash;
    }
  }
  return best;
}

std::uint64_t view_number(std::string_view name) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  DS_ASSERT(error == std::errc() && end == name.data() + name.size());
  return number;
}

/// Indices of the candidates that view number `view` of the model is made with.
std::vector<std::size_t> assigned(const Recipe& recipe, const Axis& axis, std::string_view model,
                                  std::size_t view) {
  const std::size_t count = axis.candidates.size();
  std::vector<std::size_t> indices;
  if (axis.assign == Assign::all) {
    for (std::size_t i = 0; i < count; ++i)
      indices.push_back(i);
  } else if (count > 0 && axis.assign == Assign::cycle) {
    const std::uint64_t start = seeded_hash(recipe.seed, axis.purpose, {model}) % count;
    // The view's own number, not its place in the list: camera.views leaves the others as they are.
    indices.push_back((start + view_number(recipe.view_names[view])) % count);
  } else if (count > 0) {
    indices.push_back(highest_hash(recipe, axis, model, recipe.view_names[view]));
  }
  return indices;
}

ModelLabel label_of(const Recipe& recipe, const std::string& model) {
  if (const auto label = recipe.labels.find(model)) return *label;
  if (!recipe.split_test_fraction) return {};
  const double share =
      static_cast<double>(top_53_bits(seeded_hash(recipe.seed, k_for_split, {model}))) * 0x1p-53;
  return {"", share < *recipe.split_test_fraction ? "test" : "train"};
}

/// What an axis gives an image: the file and its name.
struct Asset {
  Shared<fs::path> path;
  Shared<std::string> name;
};

std::vector<Asset> assets_of(const Axis& axis) {
  std::vector<Asset> assets;
  for (const fs::path& path : axis.candidates)
    assets.push_back({path, axis.name(path)});
  return assets;
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
  const std::vector<Asset> material_assets = assets_of(materials);
  const std::vector<Asset> environment_assets = assets_of(environments);
  const std::vector<Shared<std::string>> views(recipe.view_names.begin(), recipe.view_names.end());
  std::vector<fs::path> models = recipe.models;
  std::stable_sort(models.begin(), models.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename() < b.filename();
  });
  ImageSpec image;
  for (const fs::path& model : models) {
    const std::string name = model.filename().string();
    const ModelLabel label = label_of(recipe, name);
    image.model_file = model;
    image.model_name = name;
    image.class_path = label.class_path;
    image.split = label.split;
    for (std::size_t view = 0; view < recipe.cameras.size(); ++view) {
      image.view = views[view];
      image.camera = recipe.cameras[view];
      const auto places = assigned(recipe, environments, name, view);
      for (const std::size_t material : assigned(recipe, materials, name, view)) {
        image.material_file = material_assets[material].path;
        image.material_name = material_assets[material].name;
        for (const std::size_t environment : places) {
          image.environment_folder = environment_assets[environment].path;
          image.environment_name = environment_assets[environment].name;
          image.id = fmt::format("{}/{}{}", name, *image.view,
                                 suffix(recipe, image.material_name, image.environment_name));
          image.engine = recipe.engine;
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
  for (const fs::path& model : recipe.models)
    if (std::string name = model.filename().string(); !models.insert(name).second) refuse(name, "");
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

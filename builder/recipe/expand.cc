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

ImageSpec make_image(const Recipe& recipe, const fs::path& model, std::size_t view,
                     const fs::path& material, const fs::path& environment) {
  ImageSpec image;
  image.model_file = model;
  image.material_file = material;
  image.environment_folder = environment;
  image.model_name = model.filename().string();
  image.material_name = material_name(material);
  image.environment_name = environment_name(environment);
  image.view = recipe.view_names[view];
  image.id = image.model_name + "/" + image.view;
  if (recipe.assign_materials == Assign::all) image.id += "-" + image.material_name;
  if (recipe.assign_environments == Assign::all) image.id += "-" + image.environment_name;
  image.camera = recipe.cameras[view];
  image.engine = recipe.engine;
  image.engine.seed = top_53_bits(seeded_hash(recipe.seed, k_for_image, {image.id}));
  return image;
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

std::vector<ImageSpec> expand(const Recipe& recipe) {
  DS_ASSERT(recipe.cameras.size() == recipe.view_names.size());
  const Axis materials{k_for_material, recipe.materials, material_name, recipe.assign_materials,
                       recipe.materials_per};
  const Axis environments{k_for_environment, recipe.environments, environment_name,
                          recipe.assign_environments, recipe.environments_per};
  std::vector<fs::path> models = recipe.models;
  std::stable_sort(models.begin(), models.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename() < b.filename();
  });
  std::vector<ImageSpec> images;
  std::set<std::string> ids;
  for (const fs::path& model : models) {
    const std::string name = model.filename().string();
    const ModelLabel label = label_of(recipe, name);
    for (std::size_t view = 0; view < recipe.cameras.size(); ++view) {
      for (const std::size_t material : assigned(recipe, materials, name, view)) {
        for (const std::size_t environment : assigned(recipe, environments, name, view)) {
          ImageSpec image = make_image(recipe, model, view, recipe.materials[material],
                                       recipe.environments[environment]);
          image.class_path = label.class_path;
          image.split = label.split;
          if (!ids.insert(image.id).second)
            fail(ErrorKind::recipe, "two images would have one name: {}", image.id);
          images.push_back(std::move(image));
        }
      }
    }
  }
  return images;
}

}  // namespace ds

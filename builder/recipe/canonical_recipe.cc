// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/canonical_recipe.h"

#include "builder/recipe/lights.h"

#include <fmt/format.h>

#include <optional>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : ", ") + to_toml(name);
  return "[" + list + "]";
}

std::string list_of_names(const std::vector<ModelFile>& models) {
  std::vector<std::string> names;
  for (const ModelFile& model : models)
    names.push_back(model.name);
  return list_of(names);
}

std::string list_of_names(const std::vector<fs::path>& paths) {
  std::vector<std::string> names;
  for (const fs::path& path : paths)
    names.push_back(path.filename().string());
  return list_of(names);
}

std::optional<std::string> own_text(const KeySpec& key, const Recipe& recipe) {
  if (key.name == "dataset.name") return to_toml(recipe.name);
  if (key.name == "models.files") return list_of_names(recipe.models);
  if (key.name == "materials.files" && recipe.assign_materials != Assign::own)
    return list_of_names(recipe.materials);
  if (key.name == "distractors.dir" && !recipe.distractors.models.empty())
    return to_toml(recipe.distractors.of_recipe ? std::string(k_recipe_models)
                                                : recipe.distractors.folder);
  if (key.name == "environments.files") return list_of_names(recipe.environments);
  if (key.name == "classes.train" && recipe.train_classes)
    return to_toml(recipe.train_classes->filename().string());
  if (key.name == "classes.test" && recipe.test_classes)
    return to_toml(recipe.test_classes->filename().string());
  if (key.name == "classes.from" && !recipe.classes_from.empty())
    return to_toml(recipe.classes_from);
  if (key.name == "classes.ids" && !recipe.class_ids.empty()) return list_of(recipe.class_ids);
  if (key.name == "classes.more" && !recipe.hierarchies.empty()) {
    std::vector<std::string> names;
    for (const Hierarchy& hierarchy : recipe.hierarchies)
      names.push_back(hierarchy.name);
    return list_of(names);
  }
  return std::nullopt;
}

bool is_number_type(KeyType type) {
  return type == KeyType::number || type == KeyType::point || type == KeyType::quaternion ||
         type == KeyType::point_list || type == KeyType::patterns;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> canonical_settings(const Settings& settings,
                                                                    const Recipe& recipe) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const KeySpec& key : recipe_keys()) {
    const RecipeValue* value = settings.find(key.name);
    if (const auto text = own_text(key, recipe)) {
      lines.emplace_back(key.name, *text);
    } else if (key.type == KeyType::lights) {
      lines.emplace_back(key.name, canonical_light_list(*value));
    } else if (value != nullptr && key.type != KeyType::path && settings.applies(key)) {
      lines.emplace_back(key.name,
                         to_toml(is_number_type(key.type) ? with_numbers(*value) : *value));
    }
  }
  return lines;
}

std::string canonical_recipe(const Recipe& recipe) {
  std::string text;
  for (const auto& [key, value] : recipe.settings)
    text += fmt::format("{} = {}\n", key, value);
  return text;
}

}  // namespace ds

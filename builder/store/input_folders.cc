// SPDX-License-Identifier: Apache-2.0
#include "builder/store/input_folders.h"

#include "tracer/base/error.h"

#include <initializer_list>
#include <map>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(path, error);
  if (error) place = path.lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

/// Each folder once, and what lies in it. A benchmark's thousands of models have few.
std::map<fs::path, const char*> input_folders(const Recipe& recipe) {
  std::map<fs::path, const char*> found;
  const auto add = [&](const std::vector<fs::path>& files, const char* what) {
    for (const fs::path& file : files)
      found.try_emplace(file.parent_path(), what);
  };
  found.emplace(recipe.file.parent_path(), "the recipe");
  std::vector<fs::path> models;
  for (const ModelFile& model : recipe.models)
    models.push_back(model.file);
  add(models, "models");
  std::vector<fs::path> distractors;
  for (const DistractorModel& model : recipe.distractors.models)
    distractors.push_back(model.file);
  add(distractors, "distractors");
  add(recipe.materials, "materials");
  for (const fs::path& folder : recipe.environments)
    found.try_emplace(folder, "an environment");
  add(recipe.environments, "environments");
  add(recipe.class_files, "class files");
  return found;
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const fs::path way = path.lexically_relative(folder);
  return !way.empty() && *way.begin() != "..";
}

}  // namespace

void check_no_input_folder(const fs::path& folder, std::string_view option, const Recipe& recipe) {
  const fs::path place = resolved(folder);
  for (const auto& [input, what] : input_folders(recipe)) {
    const fs::path input_place = resolved(input);
    bool hit = input_place == place;
    for (const char* own : {"images", "manifest", ".dsbuild"})
      hit = hit || is_inside(input_place, place / own);
    if (hit)
      fail(ErrorKind::usage,
           "{0} {1}: wanted a folder for what is made, found that of {2} ({3}), which a recipe "
           "reads "
           "and builds would write into; give another, for example {0} {4}",
           option, folder.string(), what, input.string(), (place.parent_path() / "out").string());
  }
}

void check_no_input_file(const fs::path& file, std::string_view option, const Recipe& recipe) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  std::vector<fs::path> inputs{recipe.file};
  for (const ModelFile& model : recipe.models)
    inputs.push_back(model.file);
  for (const DistractorModel& model : recipe.distractors.models)
    inputs.push_back(model.file);
  inputs.insert(inputs.end(), recipe.materials.begin(), recipe.materials.end());
  inputs.insert(inputs.end(), recipe.class_files.begin(), recipe.class_files.end());
  for (const fs::path& input : inputs)
    if (fs::equivalent(file, input, error))
      fail(ErrorKind::usage, "{} {}: is read by the recipe and would be written over", option,
           file.string());
}

}  // namespace ds

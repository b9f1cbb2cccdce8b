// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/class_files.h"

#include "manifests/class_table.h"
#include "tracer/base/file_names.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/nearest.h"
#include "tracer/base/text_lines.h"
#include "tracer/base/utf8.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_models_dir = "{models.dir}";

std::string_view trimmed(std::string_view line) {
  constexpr std::string_view k_blank = " \t";
  const std::size_t begin = line.find_first_not_of(k_blank);
  if (begin == line.npos || line[begin] == '#') return {};
  return line.substr(begin, line.find_last_not_of(k_blank) - begin + 1);
}

}  // namespace

std::string_view split_of_class_file(const fs::path& file) {
  const std::string stem = file.stem().string();
  for (const auto& [ending, split] : {std::pair("rain", "train"), std::pair("est", "test")})
    if (stem.ends_with(std::string("T") + ending) || stem.ends_with(std::string("t") + ending))
      return split;
  return "";
}

std::string hierarchy_name(const fs::path& file) {
  std::string name = file.stem().string();
  if (const std::string_view split = split_of_class_file(file); !split.empty()) {
    name.resize(name.size() - split.size());
    while (!name.empty() && std::string_view("-_. ").find(name.back()) != std::string_view::npos)
      name.pop_back();
  }
  return name.empty() ? fs::absolute(file).parent_path().filename().string() : name;
}

bool is_of_absent_folder(const Settings& settings, const RecipeValue& path) {
  return path.text()->find(k_models_dir) != std::string::npos &&
         settings.find("models.dir") == nullptr;
}

std::optional<fs::path> find_class_file(const Settings& settings, const RecipeValue& path,
                                        const std::string& key) {
  std::string text = *path.text();
  const RecipeValue* dir = settings.find("models.dir");
  const std::size_t at = text.find(k_models_dir);
  if (at != text.npos && dir == nullptr) return std::nullopt;
  if (at != text.npos) text.replace(at, k_models_dir.size(), settings.resolve(*dir).string());
  fs::path file = settings.resolve(path, text);
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file;
  // A models.dir that is none has its own finding.
  if (at != text.npos && dir != nullptr && !fs::is_directory(settings.resolve(*dir), error))
    return std::nullopt;
  settings.complain(
      path, key,
      fmt::format("must name a file, found none at {}{}", file.string(), similar_name(file)));
  return std::nullopt;
}

std::vector<LabelledModel> read_class_list(const fs::path& file) {
  if (has_ending(file, ".csv")) return parse_class_table(read_text_file(file), file.string());
  return labelled_models(read_classification(file), "");
}

void add_findings(const Error& error, Diagnostics& diagnostics) {
  diagnostics.add({}, "{}", error.what());
}

void read_hierarchies(const Settings& settings, Recipe& recipe) {
  const RecipeValue* files = settings.find("classes.more");
  if (files == nullptr) return;
  Diagnostics& diagnostics = settings.diagnostics();
  std::map<std::string, std::map<std::string, LabelledModel>> found;
  for (const RecipeValue& value : *files->array()) {
    const auto file = find_class_file(settings, value, "classes.more");
    if (!file) continue;
    if (!has_ending(*file, ".cla") && !has_ending(*file, ".csv")) {
      settings.complain(value, "classes.more",
                        fmt::format("must be .cla and .csv files, got {:?}", *value.text()));
      continue;
    }
    recipe.class_files.push_back(*file);
    try {
      auto& models = found[hierarchy_name(*file)];
      bool has_splits = false;
      for (LabelledModel& model : read_class_list(*file)) {
        has_splits = has_splits || !model.label.split.empty();
        const auto [first, is_new] = models.try_emplace(model.model, model);
        if (!is_new)
          diagnostics.add(model.place, "model {} stands in {} already", model.model,
                          to_string(first->second.place));
      }
      if (has_splits)
        warn(
            fmt::format("{}: the column split is not used: a file of classes.more gives further "
                        "classes, no splits",
                        file->string()));
    } catch (const Error& error) {
      add_findings(error, diagnostics);
    }
  }
  for (auto& [name, models] : found) {
    std::vector<LabelledModel> list;
    for (auto& [model, labelled] : models)
      list.push_back(std::move(labelled));
    recipe.hierarchies.push_back({name, Labels(list)});
  }
}

namespace {

/// A list of classes that lacks one that a model is of: most likely its name is misspelt.
void warn_of_unlisted_classes(const Recipe& recipe, const fs::path& ids) {
  std::set<std::string_view> said;
  for (const ModelFile& model : recipe.models) {
    const auto index = recipe.labels.find_index(model.name);
    if (!index) continue;
    const LabelledModel& entry = recipe.labels.entry(*index);
    const std::string& path = entry.label.class_path;
    const bool known = path.empty() || std::find(recipe.class_ids.begin(), recipe.class_ids.end(),
                                                 path) != recipe.class_ids.end();
    if (known || !said.insert(path).second) continue;
    const std::string place =
        entry.place.file.empty() ? model.file.string() : to_string(entry.place);
    const std::string_view meant = nearest(path, recipe.class_ids);
    warn(fmt::format("{}: class {} is no line of {}{}", place, path, ids.string(),
                     meant.empty() ? ": its id comes behind those of the lines"
                                   : fmt::format(", did you mean {}?", meant)));
  }
}

}  // namespace

void read_class_ids(const Settings& settings, Recipe& recipe) {
  const RecipeValue* value = settings.find("classes.ids");
  if (value == nullptr) return;
  const auto file = find_class_file(settings, *value, "classes.ids");
  if (!file) return;
  recipe.class_files.push_back(*file);
  Diagnostics& diagnostics = settings.diagnostics();
  std::map<std::string, int, std::less<>> lines;
  try {
    const std::string text = read_text_file(*file);
    if (!check_utf8(text, file->string(), diagnostics)) return;
    std::string_view rest = without_bom(text);
    for (int line = 1; !rest.empty(); ++line) {
      const std::string path = trimmed_class(trimmed(take_line(rest)));
      if (path.empty()) continue;
      const SourcePlace place{file->string(), line, 0};
      const auto [first, is_new] = lines.try_emplace(path, line);
      if (!is_new)
        diagnostics.add(place, "class {} stands in line {} already", path, first->second);
      if (!is_class_path(path))
        diagnostics.add(place,
                        "a class must be names with / between, none of 0 . .., without control "
                        "characters, got {:?}",
                        path);
      recipe.class_ids.push_back(path);
    }
  } catch (const Error& error) {
    add_findings(error, diagnostics);
  }
  if (diagnostics.empty()) warn_of_unlisted_classes(recipe, *file);
}

}  // namespace ds

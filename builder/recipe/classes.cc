// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/classes.h"

#include "builder/recipe/class_files.h"
#include "builder/recipe/split_folders.h"
#include "manifests/class_table.h"
#include "manifests/concerns.h"
#include "tracer/base/file_names.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Where a class key leads: nothing where it is unset.
std::optional<fs::path> class_file(Settings& settings, const std::string& key) {
  const RecipeValue* value = settings.find(key);
  if (value == nullptr) return std::nullopt;
  if (is_of_absent_folder(settings, *value)) {
    settings.unset(key);
    return std::nullopt;
  }
  return find_class_file(settings, *value, key);
}

std::optional<Classification> read_class_file(const std::optional<fs::path>& file,
                                              Diagnostics& diagnostics) {
  if (!file) return std::nullopt;
  try {
    return read_classification(*file);
  } catch (const Error& error) {
    add_findings(error, diagnostics);
    return std::nullopt;
  }
}

/// "1298, 1299, 1300 and 4 more"
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t k_shown = 3;
  const auto shown = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), k_shown));
  std::string text = fmt::format("{}", fmt::join(names.begin(), shown, ", "));
  if (names.size() > k_shown) text += fmt::format(" and {} more", names.size() - k_shown);
  return text;
}

/// An entry that no model uses, since another one means the same file, must not tell something else.
void refuse_second_labels(Diagnostics& diagnostics, const Labels& labels,
                          const std::vector<ModelFile>& models) {
  std::set<std::size_t> used;
  for (const ModelFile& model : models)
    if (const auto entry = labels.find_index(model.name)) used.insert(*entry);
  const auto text = [](const LabelledModel& entry) {
    const auto& [path, split] = entry.label;
    return fmt::format("{} ({}{}{})", entry.model, path, path.empty() || split.empty() ? "" : ", ",
                       split);
  };
  for (const ModelFile& model : models) {
    const std::vector<std::size_t> entries = labels.find_all(model.name);
    for (std::size_t i = 1; i < entries.size(); ++i) {
      if (used.contains(entries[i]) || labels.label(entries[i]) == labels.label(entries[0]))
        continue;
      const LabelledModel& first = labels.entry(entries[0]);
      const LabelledModel& second = labels.entry(entries[i]);
      diagnostics.add(second.place, "must list {} once, found {} and, in {}, {}", model.name,
                      text(second), to_string(first.place), text(first));
    }
  }
}

/// One model in two formats is in a dataset twice, and whatever stem a class file lists, in one split
/// or the other.
void find_ambiguous_entries(Recipe& recipe) {
  std::map<std::size_t, std::vector<std::string>> models;  // by entry
  for (const ModelFile& model : recipe.models)
    for (const std::size_t entry : recipe.labels.find_all(model.name))
      models[entry].push_back(model.name);
  ClassCoverage& coverage = recipe.coverage;
  for (const auto& [entry, names] : models) {
    if (names.size() < 2) continue;
    if (++coverage.ambiguous <= k_concern_examples)
      coverage.ambiguous_examples.push_back(
          fmt::format("{} ({})", recipe.labels.name(entry), some_of(names)));
  }
}

/// Compares the class files with the models found, and does about the differences what the recipe
/// says.
void match_labels(const Settings& settings, Recipe& recipe) {
  std::set<std::size_t> used;
  std::vector<std::string> unlisted;
  std::vector<ModelFile> listed;
  for (const ModelFile& model : recipe.models) {
    if (const auto label = recipe.labels.find_index(model.name)) {
      used.insert(*label);
      listed.push_back(model);
    } else {
      unlisted.push_back(model.name);
    }
  }
  ClassCoverage& coverage = recipe.coverage;
  coverage.listed = recipe.labels.size();
  coverage.missing = recipe.labels.size() - used.size();
  coverage.files = recipe.models.size();
  coverage.unlisted = unlisted.size();
  coverage.unlisted_examples.assign(
      unlisted.begin(), unlisted.begin() + static_cast<std::ptrdiff_t>(
                                               std::min(unlisted.size(), k_concern_examples)));
  for (std::size_t i = 0;
       i < recipe.labels.size() && coverage.missing_examples.size() < k_concern_examples; ++i)
    if (!used.contains(i)) coverage.missing_examples.push_back(recipe.labels.name(i));
  coverage.missing_allowed = settings.given("classes.missing");
  coverage.unlisted_allowed = settings.given("classes.unlisted");
  refuse_second_labels(settings.diagnostics(), recipe.labels, recipe.models);
  find_ambiguous_entries(recipe);
  const std::string& wanted = settings.text("classes.unlisted");
  if (wanted == "error" && !unlisted.empty()) {
    settings.complain(
        "classes.unlisted",
        fmt::format("= \"error\" wants every model in a class file, found {} in none: {}",
                    unlisted.size(), some_of(unlisted)));
  }
  if (wanted == "skip") {
    if (listed.empty() && !recipe.models.empty()) {
      settings.complain("classes.unlisted",
                        "= \"skip\" leaves no model: no class file lists any of them");
    }
    recipe.models = std::move(listed);
  }
  if (settings.text("classes.missing") == "error" && recipe.coverage.missing > 0) {
    settings.complain(
        "classes.missing",
        fmt::format(
            "= \"error\" wants a file for every model listed, found none for {} of {}, such as {}",
            recipe.coverage.missing, recipe.coverage.listed,
            fmt::join(recipe.coverage.missing_examples, ", ")));
  }
}

/// Where classes come from that stand beside no .cla file of a split: a row each.
struct ClassSource {
  std::string_view from;  ///< the value of classes.from, or the ending of a file that it names
  bool is_file;
  /// `file` is empty where it is none. Throws Error(asset), all findings.
  std::vector<LabelledModel> (*read)(const fs::path& file, const Recipe& recipe, bool tell_splits);
};

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
}

/// The names of the first `most` folders below models.dir, without blanks around them, but for one that tells
/// the model's split. Throws Error(asset) for names of several lines and the like.
std::vector<LabelledModel> labels_of_folders(const Recipe& recipe, bool tell_splits,
                                             std::size_t most) {
  const SplitFolders splits(recipe.models);
  std::vector<LabelledModel> models;
  Diagnostics diagnostics(ErrorKind::asset);
  std::set<std::string> refused;
  for (const ModelFile& model : recipe.models) {
    LabelledModel labelled{model.name, {}, {}};
    auto& [path, split] = labelled.label;
    std::size_t levels = 0;
    std::string parent;
    for (const fs::path& folder : fs::path(model.below).parent_path()) {
      const std::string name = folder.string();
      const std::string_view told =
          split.empty() && tell_splits ? splits.split_of(parent, name) : std::string_view();
      if (!told.empty())
        split = told;
      else if (levels++ < most)
        path += (path.empty() ? "" : "/") + trimmed_class(name);
      parent += "/" + name;
    }
    if (has_control(path) && refused.insert(path).second)
      diagnostics.add({}, "a folder whose name is a class must have no control character, got {:?}",
                      path);
    if (levels > 0 || !split.empty()) models.push_back(std::move(labelled));
  }
  diagnostics.throw_if_any();
  return models;
}

constexpr ClassSource k_class_sources[] = {
    {"folder", false,
     [](const fs::path&, const Recipe& recipe, bool tell_splits) {
       return labels_of_folders(recipe, tell_splits, 1);
     }},
    {"folders", false,
     [](const fs::path&, const Recipe& recipe, bool tell_splits) {
       return labels_of_folders(recipe, tell_splits, SIZE_MAX);
     }},
    {".csv", true, [](const fs::path& file, const Recipe&, bool) { return read_class_list(file); }},
    {".cla", true,
     [](const fs::path& file, const Recipe&, bool) { return read_class_list(file); }}};

/// The row that a value of classes.from means; null, with a finding, for none.
const ClassSource* source_of(Settings& settings, const RecipeValue& from) {
  const std::string& text = *from.text();
  std::vector<std::string> known;
  for (const ClassSource& source : k_class_sources) {
    if (source.is_file ? has_ending(text, source.from) : text == source.from) return &source;
    known.push_back(source.is_file ? fmt::format("a {} file", source.from)
                                   : fmt::format("\"{}\"", source.from));
  }
  settings.complain(from, "classes.from",
                    fmt::format("must be {}, got {:?}", fmt::join(known, " or "), text));
  return nullptr;
}

/// classes.from; false where it is not given, or cannot be read.
bool read_one_source(Settings& settings, Recipe& recipe) {
  const RecipeValue* from = settings.find("classes.from");
  if (from == nullptr) return false;
  for (const char* key : {"classes.train", "classes.test"})
    if (settings.find(key) != nullptr)
      settings.complain(*from, "classes.from",
                        fmt::format("must not be given together with {}", key));
  const ClassSource* source = source_of(settings, *from);
  if (source == nullptr) return false;
  if (!source->is_file &&
      (settings.find("models.dir") == nullptr || !settings.boolean("models.recursive")))
    settings.complain(
        *from, "classes.from",
        "wants models.dir and models.recursive = true: classes are the folders in it");
  std::optional<fs::path> file;
  if (source->is_file) {
    file = class_file(settings, "classes.from");
    if (!file) return false;
    recipe.class_table = file;
  }
  recipe.classes_from = file ? file->filename().string() : *from->text();
  try {
    recipe.labels = Labels(
        source->read(file.value_or(fs::path()), recipe, settings.boolean("classes.split_folders")));
  } catch (const Error& error) {
    add_findings(error, settings.diagnostics());
    return false;
  }
  recipe.class_paths = recipe.labels.class_paths();
  return true;
}

/// classes.train and classes.test; false where neither is given.
bool read_class_files(Settings& settings, Recipe& recipe) {
  recipe.train_classes = class_file(settings, "classes.train");
  recipe.test_classes = class_file(settings, "classes.test");
  const bool has_files =
      settings.find("classes.train") != nullptr || settings.find("classes.test") != nullptr;
  Diagnostics& diagnostics = settings.diagnostics();
  const auto train = read_class_file(recipe.train_classes, diagnostics);
  const auto test = read_class_file(recipe.test_classes, diagnostics);
  if (!has_files) return false;
  recipe.class_paths = class_paths(train, test);
  try {
    recipe.labels = Labels(train, test);
  } catch (const Error& error) {
    add_findings(error, diagnostics);
  }
  if (!diagnostics.empty()) return true;
  recipe.coverage.unshared = unshared_classes(train, test);
  recipe.coverage.unshared_allowed = settings.given("classes.unshared");
  if (settings.text("classes.unshared") == "error" && !recipe.coverage.unshared.classes.empty()) {
    settings.complain(
        "classes.unshared",
        fmt::format("= \"error\" wants the same classes in both class files, found in "
                    "one of them only: {}",
                    some_of(recipe.coverage.unshared.classes)));
  }
  return true;
}

}  // namespace

void read_classes(Settings& settings, Recipe& recipe) {
  const bool has_files = read_class_files(settings, recipe);
  const bool has_source = read_one_source(settings, recipe);
  if (settings.given("classes.split_folders") && !settings.misspelt("classes.from") &&
      recipe.classes_from != "folder" && recipe.classes_from != "folders")
    settings.complain("classes.split_folders",
                      "has no effect without classes.from = \"folder\" or \"folders\"");
  if ((has_files || has_source) && settings.diagnostics().empty()) match_labels(settings, recipe);
  for (const auto& file : {recipe.train_classes, recipe.test_classes, recipe.class_table})
    if (file) recipe.class_files.push_back(*file);
  read_hierarchies(settings, recipe);
  for (const Hierarchy& hierarchy : recipe.hierarchies)
    refuse_second_labels(settings.diagnostics(), hierarchy.labels, recipe.models);
  read_class_ids(settings, recipe);
}

}  // namespace ds

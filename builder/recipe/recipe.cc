// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"

#include "builder/recipe/assets.h"
#include "builder/recipe/camera_sets.h"
#include "builder/recipe/canonical_recipe.h"
#include "builder/recipe/planes.h"
#include "builder/recipe/settings.h"
#include "manifests/concerns.h"
#include "tracer/base/files.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// The enumerator at the place of the choice's text. `names` in the enumeration's order.
template <typename Enum, std::size_t N>
Enum chosen(const Settings& settings, std::string_view key,
            const std::array<std::string_view, N>& names) {
  const auto at = std::find(names.begin(), names.end(), settings.text(key));
  DS_ASSERT(at != names.end());
  return static_cast<Enum>(at - names.begin());
}

NormaliseOptions read_normalise(const Settings& settings) {
  NormaliseOptions options;
  options.up = chosen<UpAxis, 2>(settings, "models.up", {"y", "z"});
  options.size_m = settings.number("models.size_m");
  options.place_on_ground = settings.find("models.ground_z_m")->is_number();
  if (options.place_on_ground) options.ground_z_m = settings.number("models.ground_z_m");
  options.centre = chosen<Centring, 3>(settings, "models.centre", {"none", "mass", "box"});
  options.normals = chosen<Normals, 3>(settings, "models.normals", {"smooth", "keep", "flat"});
  options.crease_deg = settings.number("models.crease_deg");
  return options;
}

EngineSettings read_engine(const Settings& settings) {
  EngineSettings engine;
  engine.width = settings.integer("engine.width");
  engine.height = settings.integer("engine.height");
  engine.spp = settings.integer("engine.spp");
  if (settings.find("engine.error")->is_number()) {
    ErrorTarget& target = engine.target.emplace();
    target.error = settings.number("engine.error");
    target.max_spp = settings.integer("engine.max_spp");
    target.region = chosen<ErrorRegion, 2>(settings, "engine.error_region", {"image", "model"});
  }
  engine.depth_total = settings.integer("engine.depth_total");
  engine.depth_diffuse = settings.integer("engine.depth_diffuse");
  engine.depth_glossy = settings.integer("engine.depth_glossy");
  engine.depth_specular = settings.integer("engine.depth_specular");
  engine.roulette_depth = settings.integer("engine.roulette_depth");
  engine.roulette_cap = static_cast<float>(settings.number("engine.roulette_cap"));
  engine.filter_width = static_cast<float>(settings.number("engine.filter_width"));
  engine.outlier_limit = static_cast<float>(settings.number("engine.outlier_limit"));
  engine.math = chosen<MathMode, 2>(settings, "engine.math", {"strict", "fast"});
  return engine;
}

OutputSettings read_outputs(const Settings& settings) {
  OutputSettings outputs;
  outputs.image = settings.find("outputs.image")->text() != nullptr;
  outputs.planes = read_planes(settings);
  if (!outputs.image && outputs.planes.empty() && !settings.misfits("outputs.planes"))
    settings.complain("outputs.image", "is off, and so are mask and depth; wanted one at least");
  if (settings.text("outputs.tone_map") == "environment") return outputs;
  ToneMap& map = outputs.tone_map.emplace();
  map.kind = chosen<ToneMap::Kind, 3>(settings, "outputs.tone_map",
                                      {"linear", "reinhard02", "autolinear"});
  map.scale = static_cast<float>(settings.number("outputs.tone_map_scale"));
  map.prescale = static_cast<float>(settings.number("outputs.tone_map_prescale"));
  map.postscale = static_cast<float>(settings.number("outputs.tone_map_postscale"));
  map.burn = static_cast<float>(settings.number("outputs.tone_map_burn"));
  map.gamma = static_cast<float>(settings.number("outputs.tone_map_gamma"));
  return outputs;
}

/// Where a class key leads: nothing where it is unset, or asks for a models.dir that the recipe
/// does not use.
std::optional<fs::path> class_file(Settings& settings, const std::string& key) {
  static constexpr std::string_view k_models_dir = "{models.dir}";
  const RecipeValue* value = settings.find(key);
  if (value == nullptr) return std::nullopt;
  std::string text = *value->text();
  if (const std::size_t at = text.find(k_models_dir); at != text.npos) {
    const RecipeValue* dir = settings.find("models.dir");
    if (dir == nullptr) {
      settings.unset(key);
      return std::nullopt;
    }
    text.replace(at, k_models_dir.size(), settings.resolve(*dir).string());
  }
  fs::path file = settings.resolve(*value, text);
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file;
  const RecipeValue* dir = settings.find("models.dir");
  // A models.dir that is none has its own finding.
  const bool of_dir = text != *value->text();
  if (of_dir && dir != nullptr && !fs::is_directory(settings.resolve(*dir), error))
    return std::nullopt;
  settings.complain(
      *value, key,
      fmt::format("must name a file, found none at {}{}", file.string(), similar_name(file)));
  return std::nullopt;
}

/// Adds a parser's findings, which carry their own places, to the recipe's.
void add_findings(const Error& error, Diagnostics& diagnostics) {
  diagnostics.add({}, "{}", error.what());
}

std::optional<Classification> read_classes(const std::optional<fs::path>& file,
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
void refuse_second_labels(const Settings& settings, const Recipe& recipe,
                          const std::set<std::size_t>& used) {
  const Labels& labels = recipe.labels;
  const auto text = [&](std::size_t entry) {
    const ModelLabel& label = labels.label(entry);
    return fmt::format("{} ({}, {})", labels.name(entry), label.class_path, label.split);
  };
  for (const ModelFile& model : recipe.models) {
    const std::vector<std::size_t> entries = labels.find_all(model.name);
    for (std::size_t i = 1; i < entries.size(); ++i)
      if (!used.contains(entries[i]) && labels.label(entries[i]) != labels.label(entries[0]))
        settings.complain(
            labels.label(entries[0]).split == "test" ? "classes.test" : "classes.train",
            fmt::format("must list {} once, found {} and {}", model.name, text(entries[0]),
                        text(entries[i])));
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
  refuse_second_labels(settings, recipe, used);
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

void read_classification_section(Settings& settings, Recipe& recipe) {
  recipe.train_classes = class_file(settings, "classes.train");
  recipe.test_classes = class_file(settings, "classes.test");
  const bool has_files =
      settings.find("classes.train") != nullptr || settings.find("classes.test") != nullptr;
  if (const RecipeValue* test = settings.find("classes.split.test")) {
    recipe.split_test_fraction = test->number();
    if (has_files) {
      settings.complain(*test, "classes.split.test",
                        "must not be given together with classes.train or classes.test");
    }
  }
  Diagnostics& diagnostics = settings.diagnostics();
  const auto train = read_classes(recipe.train_classes, diagnostics);
  const auto test = read_classes(recipe.test_classes, diagnostics);
  recipe.class_paths = class_paths(train, test);
  try {
    recipe.labels = Labels(train, test);
  } catch (const Error& error) {
    add_findings(error, diagnostics);
  }
  if (!has_files || !diagnostics.empty()) return;
  recipe.coverage.unshared = unshared_classes(train, test);
  recipe.coverage.unshared_allowed = settings.given("classes.unshared");
  if (settings.text("classes.unshared") == "error" && !recipe.coverage.unshared.classes.empty()) {
    settings.complain(
        "classes.unshared",
        fmt::format("= \"error\" wants the same classes in both class files, found in "
                    "one of them only: {}",
                    some_of(recipe.coverage.unshared.classes)));
  }
  match_labels(settings, recipe);
}

/// With "all", a name becomes part of a picture's stem, and what stands before a stem's first dot
/// must tell pictures apart: WebDataset readers take the rest as the ending.
void check_stem_names(const Settings& settings, std::string_view key,
                      const std::vector<fs::path>& assets, std::string (*name)(const fs::path&)) {
  for (const fs::path& asset : assets) {
    if (name(asset).find('.') == std::string::npos) continue;
    settings.complain(key, fmt::format("= \"all\" wants names without a dot, got {}", name(asset)));
  }
}

void read_assignments(Settings& settings, Recipe& recipe) {
  recipe.assign_materials =
      chosen<Assign, 3>(settings, "materials.assign", {"random", "cycle", "all"});
  recipe.materials_per = chosen<ChoosePer, 2>(settings, "materials.per", {"model", "view"});
  recipe.assign_environments =
      chosen<Assign, 3>(settings, "environments.assign", {"random", "cycle", "all"});
  recipe.environments_per = chosen<ChoosePer, 2>(settings, "environments.per", {"model", "view"});
  if (recipe.assign_materials == Assign::all) {
    check_stem_names(settings, "materials.assign", recipe.materials, material_name);
  }
  if (recipe.assign_environments == Assign::all) {
    check_stem_names(settings, "environments.assign", recipe.environments, environment_name);
  }
}

std::string name_from_file(const Settings& settings, const fs::path& file) {
  if (settings.find("dataset.name") != nullptr) return settings.text("dataset.name");
  std::string stem = file.stem().string();
  const KeySpec* key = find_key("dataset.name");
  if (!settings.given("dataset.name") && !fits(*key, parse_value(to_toml(stem)))) {
    settings.complain("dataset.name",
                      fmt::format("must be given, since the recipe's own is not {}, got {:?}",
                                  wanted_text(*key), stem));
  }
  return stem;
}

/// What a file of another kind was most likely meant for; "" for any other ending.
std::string_view kind_of_other_file(const fs::path& file) {
  if (has_mesh_ending(file)) return "a model, which models.dir or models.files of a recipe names";
  static constexpr std::pair<std::string_view, std::string_view> k_kinds[] = {
      {".mat", "a material, which materials.dir or materials.files of a recipe names"},
      {".scn", "a scene, whose folder environments.dir or environments.files of a recipe names"},
      {".cla", "a class file, which classes.train or classes.test of a recipe names"}};
  for (const auto& [ending, kind] : k_kinds)
    if (file.extension() == ending) return kind;
  return "";
}

}  // namespace

Recipe read_recipe(const fs::path& file, const std::vector<std::string>& overrides) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    const fs::path with_ending = file.string() + ".toml";
    fail(ErrorKind::recipe, "{}: must be a recipe, found no file{}", file.string(),
         fs::is_regular_file(with_ending, error)
             ? fmt::format(", did you mean {}?", with_ending.string())
             : similar_name(file));
  }
  if (const std::string_view kind = kind_of_other_file(file); !kind.empty())
    fail(ErrorKind::recipe, "{}: must be a recipe (.toml), found {}", file.string(), kind);
  Diagnostics diagnostics(ErrorKind::recipe);
  RecipeValue::Table tree = parse_recipe_text(read_text_file(file), file.string(), diagnostics);
  const bool parsed = diagnostics.empty();
  for (const std::string& assignment : overrides)
    apply_override(assignment, tree, diagnostics);
  if (!parsed) diagnostics.throw_if_any();  // every key would be missing

  Settings settings(file, std::move(tree), diagnostics);
  Recipe recipe;
  recipe.file = fs::absolute(file).lexically_normal();
  recipe.name = name_from_file(settings, file);
  recipe.seed = static_cast<std::uint64_t>(*settings.find("dataset.seed")->integer());
  recipe.licence = settings.text("dataset.licence");
  recipe.models = find_models(settings);
  recipe.materials = find_materials(settings);
  recipe.environments = find_environments(settings);
  recipe.normalise = read_normalise(settings);
  read_classification_section(settings, recipe);
  read_assignments(settings, recipe);
  CameraViews views = make_cameras(settings);
  recipe.cameras = std::move(views.cameras);
  recipe.view_names = std::move(views.names);
  recipe.camera_fit = views.fit;
  recipe.engine = read_engine(settings);
  recipe.outputs = read_outputs(settings);
  recipe.rejected_limit = settings.number("engine.rejected_limit");
  recipe.keep_sums = settings.boolean("engine.keep_film");
  recipe.keep_film = settings.boolean("outputs.keep_film");
  diagnostics.throw_if_any();
  recipe.settings = canonical_settings(settings, recipe);
  check_ids(recipe);
  return recipe;
}

}  // namespace ds

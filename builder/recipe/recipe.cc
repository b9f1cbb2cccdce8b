// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"

#include "builder/recipe/assets.h"
#include "builder/recipe/camera_sets.h"
#include "builder/recipe/canonical_recipe.h"
#include "builder/recipe/classes.h"
#include "builder/recipe/distractors.h"
#include "builder/recipe/lights.h"
#include "builder/recipe/planes.h"
#include "builder/recipe/settings.h"
#include "builder/recipe/splits.h"
#include "builder/recipe/vary_patterns.h"
#include "tracer/base/files.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <array>
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
  recipe.assign_materials = chosen<Assign, 5>(
      settings, "materials.assign", {"random", "cycle", "all", "balanced", k_own_materials});
  recipe.materials_per = chosen<ChoosePer, 2>(settings, "materials.per", {"model", "view"});
  recipe.assign_environments =
      chosen<Assign, 4>(settings, "environments.assign", {"random", "cycle", "all", "balanced"});
  recipe.environments_per = chosen<ChoosePer, 2>(settings, "environments.per", {"model", "view"});
  if (recipe.assign_materials == Assign::all) {
    check_stem_names(settings, "materials.assign", recipe.materials, material_name);
  }
  if (recipe.assign_environments == Assign::all) {
    check_stem_names(settings, "environments.assign", recipe.environments, environment_name);
  }
}

/// YYYY-MM-DD.
bool is_date(std::string_view text) {
  constexpr std::string_view k_form = "0000-00-00";
  return text.size() == k_form.size() &&
         std::equal(text.begin(), text.end(), k_form.begin(), [](char c, char form) {
           return form == '-' ? c == '-' : c >= '0' && c <= '9';
         });
}

std::map<std::string, std::string> read_about(const Settings& settings) {
  std::map<std::string, std::string> about;
  for (const char* name : {"description", "creator", "url", "published", "version", "cite"}) {
    const std::string key = fmt::format("dataset.{}", name);
    const std::string& text = settings.text(key);
    if (!text.empty()) about.emplace(name, text);
    if (name == std::string_view("published") && !text.empty() && !is_date(text))
      settings.complain(key, fmt::format("must be a day as 2026-11-27, got {:?}", text));
  }
  return about;
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
    fail(ErrorKind::recipe, "{}: must be a recipe or the folder of a dataset, found no file{}",
         file.string(),
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
  recipe.refuses_unlicensed = settings.text("dataset.unlicensed") == "error";
  recipe.refuses_unsourced = settings.text("dataset.unsourced") == "error";
  recipe.about = read_about(settings);
  recipe.models = find_models(settings);
  recipe.materials = find_materials(settings);
  recipe.environments = find_environments(settings);
  recipe.normalise = read_normalise(settings);
  read_classes(settings, recipe);
  read_assignments(settings, recipe);
  recipe.constants = constants_of(settings);
  recipe.normalise.size_m = recipe.constants.model_size_m;
  recipe.drawn = drawn_of(settings);
  recipe.distractors.drawn = take_draws_of_each(recipe.drawn);
  read_vary(settings, recipe);
  read_distractor_vary(settings, recipe);
  read_environment_vary(settings, recipe);
  read_recipe_lights(settings, recipe);
  CameraViews views = make_cameras(settings, recipe.constants);
  recipe.camera_set = std::move(views.set);
  recipe.cameras = std::move(views.cameras);
  recipe.view_names = std::move(views.names);
  recipe.camera_fit = views.fit;
  recipe.keep = {settings.number("camera.keep.in_frame"), settings.number("camera.keep.visible"),
                 settings.number("camera.keep.clearance_m"), settings.integer("camera.keep.tries")};
  read_split(settings, recipe);
  read_distractors(settings, recipe);
  recipe.engine = read_engine(settings);
  recipe.outputs = read_outputs(settings);
  recipe.rejected_limit = settings.number("engine.rejected_limit");
  recipe.keep_sums = settings.boolean("engine.keep_sums");
  recipe.keep_film = settings.boolean("outputs.keep_film");
  diagnostics.throw_if_any();
  recipe.settings = canonical_settings(settings, recipe);
  check_ids(recipe);
  return recipe;
}

}  // namespace ds

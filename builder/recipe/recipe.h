// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/camera_fit.h"
#include "builder/recipe/camera_sets.h"
#include "builder/recipe/distractors.h"
#include "builder/recipe/lights.h"
#include "builder/recipe/shared.h"
#include "builder/recipe/variables.h"
#include "manifests/classification.h"
#include "tracer/base/error.h"
#include "tracer/render/plane_file.h"
#include "tracer/render/render.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// `own`: materials alone: each model shows those of its file.
enum class Assign { random, cycle, all, balanced, own };
/// Whether a random choice is made once for a model, or for each of its views.
enum class ChoosePer { model, view };

/// A plane that is wanted of each image, and how.
struct PlaneOutput {
  const PlaneType* type = nullptr;
  PlaneEncoding encoding = PlaneEncoding::exr;
  bool operator==(const PlaneOutput&) const = default;
};

/// Which files an image consists of.
struct OutputSettings {
  bool image = true;  ///< the path-traced picture
  /// Beside it, no two of one type, in the order of plane_types().
  std::vector<PlaneOutput> planes;
  std::optional<ToneMap> tone_map;  ///< overrides every environment's own

  const PlaneOutput* find_plane(std::string_view name) const;
  /// Adds one, or changes the encoding of the one there is.
  void set_plane(PlaneOutput plane);
};

/// How the models found and the models that the class files list agree.
struct ClassCoverage {
  std::size_t listed = 0;    ///< models that the class files list
  std::size_t missing = 0;   ///< of these, the ones that have no file
  std::size_t files = 0;     ///< model files, where there are class files
  std::size_t unlisted = 0;  ///< of these, the ones that no class file lists
  std::vector<std::string> missing_examples, unlisted_examples;  ///< the first few names
  UnsharedClasses unshared;
  /// Entries of the class files that mean several model files each, as "mug" mug.off and mug.ply.
  std::size_t ambiguous = 0;
  std::vector<std::string> ambiguous_examples;  ///< "mug (mug.off, mug.ply)", the first few
  /// The recipe itself says that they may be, with classes.missing, .unlisted and .unshared.
  bool missing_allowed = false, unlisted_allowed = false, unshared_allowed = false;
};

/// What is of one split, whole.
enum class SplitBy { model, model_class, material, environment, view };

/// Whether all images of a model are of one split.
inline bool keeps_models_whole(SplitBy by) {
  return by == SplitBy::model || by == SplitBy::model_class;
}

/// classes.split.
struct SplitSettings {
  SplitBy by = SplitBy::model;
  std::optional<double> test, val;  ///< shares of what `by` names
  std::set<std::string> held_out;   ///< or those that are test, by name
  std::set<std::string> held_out_val;
  bool stratified = false;  ///< the shares are of each class's models
  int folds = 0;            ///< 0: none
};

/// camera.keep: what a view that was drawn must fulfil.
struct KeepSettings {
  double in_frame = 0, visible = 0;  ///< least shares
  double clearance_m = 0;            ///< least; 0: none is asked
  int tries = 0;                     ///< most draws of one image

  bool any() const { return in_frame > 0 || visible > 0 || clearance_m > 0; }
};

/// A classification beside the one that images are labelled with: "coarse1" of the benchmark.
struct Hierarchy {
  std::string name;
  Labels labels;
};

/// A model's file, and what images, class files and the manifest call the model.
struct ModelFile {
  std::string name;
  std::filesystem::path file;
  std::string below = {};  ///< its path in models.dir; of models.files as it is written there
};

/// A recipe read, checked and with every default filled in. Paths are absolute. What each key
/// means, its unit and default: recipes/README.md.
struct Recipe {
  std::filesystem::path file;
  std::string name;
  std::uint64_t seed = 0;
  std::string licence;
  bool refuses_unlicensed = false;           ///< dataset.unlicensed
  bool refuses_unsourced = false;            ///< dataset.unsourced
  std::map<std::string, std::string> about;  ///< dataset.description, ... by name; those given
  std::vector<ModelFile> models;             ///< sorted by name, which no two share
  /// Material files, sorted by name, which no two share.
  std::vector<std::filesystem::path> materials;
  std::vector<std::filesystem::path> environments;  ///< folders, sorted by name, which no two share
  NormaliseOptions normalise;  ///< but for what images have of their own: see normalise_of
  std::optional<std::filesystem::path> train_classes, test_classes;
  std::string
      classes_from;  ///< "folder", "folders" or a file's name; "" where classes.from is not given
  std::optional<std::filesystem::path> class_table;  ///< that file
  Labels labels;                                     ///< of both class files, or of classes.from
  std::vector<std::string> class_paths;              ///< of the same, sorted
  ClassCoverage coverage;
  std::vector<Hierarchy> hierarchies;              ///< of classes.more, by name
  std::vector<std::string> class_ids;              ///< of classes.ids: a class's id is its index
  std::vector<std::filesystem::path> class_files;  ///< all that were read
  SplitSettings split;                             ///< what no class file says of it
  Assign assign_materials = Assign::random;
  ChoosePer materials_per = ChoosePer::model;
  Assign assign_environments = Assign::cycle;
  ChoosePer environments_per = ChoosePer::view;
  /// One a view; at a distance of 1 m with camera_fit. Not those of images where the recipe draws
  /// them.
  std::vector<Camera> cameras;
  CameraSet camera_set;
  KeepSettings keep;
  DistractorSettings distractors;
  std::vector<RecipeLight> lights;
  Variables constants;                        ///< of what is not drawn
  std::vector<Drawn> drawn;                   ///< by key
  std::vector<VaryPattern> vary;              ///< of materials
  std::vector<VaryPattern> environment_vary;  ///< of what environments' files have
  std::optional<CameraFit> camera_fit;  ///< each is moved to where its image's model just fits
  std::vector<std::string> view_names;  ///< "0", "1", ...; as long as cameras
  EngineSettings engine;
  OutputSettings outputs;
  bool keep_film = true;          ///< outputs.keep_film: the radiance, to develop it again
  bool keep_sums = false;         ///< engine.keep_sums: the sums, to go on from them
  double rejected_limit = 0.001;  ///< share of a picture's samples
  /// Every key that has an effect and a value, "engine.spp" -> "64", as canonical_recipe writes
  /// them.
  std::vector<std::pair<std::string, std::string>> settings;
};

/// `overrides` are "key=value" texts of --set, later ones win. Throws Error(recipe) with all
/// findings, each "file:line:column: ..." or "--set key: ..."; class files' own findings are among
/// them.
Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The recipe as TOML lines "section.key = value" in the order of the reference, defaults and
/// overrides filled in; no path of this machine (lists of file names stand in their place), so it
/// is the same wherever the assets lie.
std::string canonical_recipe(const Recipe& recipe);

/// The numbers of an image that another one may have otherwise.
struct ImageVariables {
  Variables values;
  DrawnValues draws;  ///< of Recipe::drawn, in its order
  int attempts = 0;   ///< draws that were rejected before these
};

/// One image to make. A pure function of the recipe.
struct ImageSpec {
  std::string id;  ///< "human.ply/0": the path of the picture under images/, less its ending
  Shared<std::string> model_name;  ///< "human.ply"; "chair/1/model.obj" with models.names = "path"
  Shared<std::filesystem::path> model_file;
  Shared<std::filesystem::path> material_file;  ///< model_file where its own are shown
  Shared<std::filesystem::path> environment_folder;
  Shared<std::string> material_name;     ///< file name less its ending; "own" of the model's own
  Shared<std::string> environment_name;  ///< folder name
  Shared<std::string> view;
  Camera camera;
  Shared<ImageVariables> variables;
  Shared<std::vector<Distractor>> distractors;  ///< those that found a place; where settled
  int unplaced = 0;                             ///< how many found none
  Shared<std::vector<Light>> lights;            ///< beside the environment's; where settled
  double lowest = 0;               ///< of its model, as lowest_of has it; known where settled
  EngineSettings engine;           ///< with this image's own seed, below 2^53
  Shared<std::string> class_path;  ///< "vehicle/car", "" where unclassified
  Shared<std::string> split;       ///< "train", "val", "test" or "" where there is none
  std::optional<std::uint64_t>
      fold;  ///< below SplitSettings::folds; none in the splits val and test
  Shared<std::map<std::string, std::string>> other_classes;  ///< class path by Recipe::hierarchies
};

/// Whether the image shows its model's own materials.
inline bool shows_own(const ImageSpec& image) {
  return !image.model_file->empty() && image.material_file.is_same(image.model_file);
}

/// All images, ordered by model name, then view, then (with assign = all) material, then
/// environment. Seeds, splits and random choices hash (recipe seed, model name, view), never an
/// index, so adding a model changes no image of another. A random choice takes the candidate of the
/// highest hash, so adding a material changes only the images that then show it. "cycle": view k
/// gets candidate (k + hash(seed, model)) mod n, so all appear equally often. "balanced": as
/// choose_balanced says, for each class of each split (of classes alone, where it is no model that is split);
/// a model added changes some of its class and split. Distributions are drawn by (seed, model, view, key): images of
/// one view in several materials and environments share them.
///
/// The id is model/view, and -material and -environment behind it for each that is assigned "all".
/// Throws Error(recipe) where two images would have one id, or an id's last part a dot.
std::vector<ImageSpec> expand(const Recipe& recipe);
/// The same, one image after another, without ever holding them all.
void expand(const Recipe& recipe, const std::function<void(ImageSpec&&)>& visit);
/// Throws what `expand` would throw.
void check_ids(const Recipe& recipe);
/// How many images `expand` gives.
std::size_t image_count(const Recipe& recipe);

/// Class path -> id, from 0 without gaps.
using ClassIds = std::map<std::string, std::uint64_t, std::less<>>;
/// Of classes.ids, in its order, and then of the paths that it does not name; "" is no class.
ClassIds class_ids(const Recipe& recipe, const std::set<std::string>& paths);

/// How the image's model is placed.
NormaliseOptions normalise_of(const ImageSpec& image, const Recipe& recipe);

/// Whether another attempt at an image gives other numbers.
bool draws_views(const Recipe& recipe);
/// Draws again what the recipe draws, for an image of which so many draws were rejected, and its
/// camera with it.
void draw_again(ImageSpec& image, const Recipe& recipe, int attempts);
/// Throws Error(recipe) where the camera that was drawn for an image sees nothing.
void check_drawn(const ImageSpec& image, const Recipe& recipe);

/// Moves an image's camera to where its model fits, which is that sphere, where the recipe wants
/// that; else nothing. Throws what `fit_camera` throws.
void fit_image(ImageSpec& image, const Recipe& recipe, const Sphere& model);

/// What they call a model's own materials.
inline constexpr const char* k_own_materials = "own";
/// The name an image and the manifest use for a material file ("red-plastic") or an environment
/// folder ("studio").
std::string material_name(const std::filesystem::path& file);
std::string environment_name(const std::filesystem::path& folder);

}  // namespace ds

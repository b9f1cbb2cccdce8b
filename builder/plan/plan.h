// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/image_scene.h"
#include "builder/plan/inputs.h"
#include "builder/plan/keys.h"
#include "builder/plan/shard.h"
#include "builder/plan/texts.h"
#include "builder/recipe/recipe.h"
#include "builder/store/dataset.h"
#include "manifests/concerns.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ds {

class PlacedFiles;

/// PlacedFile::kind of the manifest's own files.
inline constexpr const char* k_manifest_kind = "manifest";

/// What an output file needs.
enum class FileState {
  in_place,  ///< the file is there and what its key says; of Wanted::store: in the store
  in_store,  ///< only to be put into the dataset's folder
  to_make,   ///< to be developed, encoded or traced
};

struct PlannedFile {
  OutputFile output;
  FileState state = FileState::to_make;
};

/// One image, what it needs and why.
struct PlannedImage {
  ImageSpec spec;
  ImageKeys keys;
  bool elsewhere = false;          ///< of another shard: nothing below is filled but `error`
  std::vector<PlannedFile> files;  ///< as keys.outputs; none where it is up to date
  bool trace_film = false, trace_planes = false;
  bool trace_light = false;  ///< planes of light: all its samples, and those of its film with them
  std::uint64_t kept_samples = 0;    ///< of a kept film that its film goes on from
  bool record = false;               ///< the database is behind though no file is
  std::vector<std::string> reasons;  ///< why it is stale, each a sentence; empty where it is not
  std::optional<Error> error;        ///< it cannot be made: only spec, elsewhere, refused hold
  bool refused = false;  ///< its picture was made and is not wanted (check_limits); keys hold too

  bool stale() const { return !reasons.empty(); }
  bool traces_paths() const { return trace_film || trace_light; }
  /// Camera samples its film still takes; at most, with an error target.
  std::uint64_t samples() const;
};

/// A model whose file is damaged and was mended.
struct MendedModel {
  std::filesystem::path file;
  MendedDamage damage;
};

/// How the manifest that stands in the folder and the one a build would write agree, but for images
/// that are to be made.
struct ManifestState {
  std::vector<std::string> behind;  ///< each what is behind: "class_path of 4 images: car -> van"
  std::string older_program;        ///< the version that wrote it, where that is another one
  /// ManifestSources::listing, where every image of the dataset is made.
  std::optional<Hash128> listing;

  bool current() const { return behind.empty() && older_program.empty(); }
};

/// Hash of what dataset.json says and of the labels of the plan's images, or why there is none.
struct PlanLabels {
  Hash128 hash;
  std::optional<Error> error;
};

/// A build, before anything is done. A pure reading of recipe, files and database, but for
/// `Inputs`' memory of hashes.
struct Plan {
  std::vector<PlannedImage> images;    ///< of all shards, in the order of `expand`
  std::vector<std::string> to_remove;  ///< files dsbuild made, of the shard's images, that no image
                                       ///< names any more or whose picture is refused; relative to
                                       ///< the folder
  /// Files of those that a build replaces or removes, the manifest's too, that hold what no build
  /// is known to have written: they were changed, or put there, by hand.
  std::vector<std::string> edited;
  bool forgets = false;  ///< the database knows images that the recipe has no more
  PlanLabels labels;
  ManifestState manifest;
  TextSet texts;
  std::shared_ptr<PlacedFiles> placed;        ///< as the plan found them; refers to the dataset
  std::int64_t data_version = 0;              ///< Database::data_version before anything was read
  std::map<std::string, MendedModel> mended;  ///< by model name, of all shards' images
  ClassIds class_ids;                         ///< of all shards' images
  std::map<std::string, MeshExtent> extents;  ///< by model file, of those that can be read
  std::map<std::string, std::string> shapes;  ///< Inputs::model_shape by model name, likewise
  /// Names of the materials in a model's file by model name, of those that are shown in them.
  std::map<std::string, std::vector<std::string>> own_materials;
  /// Those of all shards' images that are known before any is made: assets_unphysical,
  /// sizes_unlikely, names_by_case, meshes_damaged, models_unlikely, own_materials_partial, distractors_unplaced. Findings, but for names_by_case,
  /// were warned of when they were found.
  std::vector<Concern> concerns;
  DrawCounts drawn;  ///< of all shards' images
};

/// What is to be there in the end.
enum class Wanted {
  files,  ///< every image's files, in the dataset's folder
  store,  ///< what they are placed from: no file and no manifest is looked at or made
};

/// `force`: every image of the shard is traced again. `inputs` must outlive what is executed of the
/// plan.
Plan make_plan(Dataset& dataset, Inputs& inputs, bool force, Shard shard = {},
               Wanted wanted = Wanted::files);

/// The film and file keys a plan's image had when it was last built, by the text of each part;
/// nothing for a new image.
std::vector<std::pair<std::string, PropertyChange>> changes_since(const PlannedImage& image,
                                                                  const PartHashes& before,
                                                                  const TextSet& texts,
                                                                  Database& database);

}  // namespace ds

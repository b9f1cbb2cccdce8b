// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manifests/classification.h"
#include "tracer/render/render.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/scene.h"

namespace ds {

enum class Assign { random, cycle, all };

/// Which files an image consists of. Depth is planar z.
struct OutputSettings {
  bool mask = true;
  bool depth = false;
  std::optional<ToneMap> tone_map;  ///< overrides every environment's own
};

/// A recipe read, checked and with every default filled in. Paths are absolute.
struct Recipe {
  std::filesystem::path file;
  std::string name;
  std::uint64_t seed = 0;
  std::string licence;
  std::vector<std::filesystem::path> models;        ///< sorted by file name
  std::vector<std::filesystem::path> materials;     ///< material files, sorted by name
  std::vector<std::filesystem::path> environments;  ///< folders, sorted by name
  NormaliseOptions normalise;
  std::optional<std::filesystem::path> train_classes, test_classes;
  double split_test_fraction = 0;  ///< used where there are no class files
  Assign assign_materials = Assign::random;
  Assign assign_environments = Assign::cycle;
  std::vector<Camera> cameras;         ///< one a view
  std::vector<std::string> view_names; ///< "0", "1", ...; as long as cameras
  EngineSettings engine;
  OutputSettings outputs;
  bool keep_film = true;
};

/// `overrides` are "key=value" texts of --set. Throws Error(recipe) with all findings, each "file:line:column: ...".
Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// One image to make. A pure function of the recipe.
struct ImageSpec {
  std::string id;                ///< "human.ply/0": the path of the picture under images/, less its ending
  std::string model_name;        ///< file name, "human.ply"
  std::filesystem::path model_file, material_file, environment_folder;
  std::string material_name;     ///< file name less its ending
  std::string environment_name;  ///< folder name
  std::string view;
  Camera camera;
  EngineSettings engine;         ///< with this image's own seed
  std::string class_path;        ///< "vehicle/car", "" where unclassified
  std::string split;             ///< "train", "test" or "" where there is none
};

/// All images, ordered by model name, then view. Seeds, splits and random choices hash (recipe seed, model name, view),
/// never an index, so adding a model changes no image of another.
std::vector<ImageSpec> expand(const Recipe& recipe);

}  // namespace ds

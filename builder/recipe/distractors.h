// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/shared.h"
#include "builder/recipe/value.h"
#include "builder/recipe/variables.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

class Settings;
struct ImageSpec;
struct NormaliseOptions;
struct Recipe;

/// distractors.dir of a recipe that takes its own models.
inline constexpr std::string_view k_recipe_models = "{models}";
/// Most distractors of an image.
inline constexpr int k_most_distractors = 15;
/// Object id of the first; those of a number n have this and n, whether or not others found a place.
inline constexpr std::uint32_t k_first_distractor_id = 101;

/// A model that images may show beside their own.
struct DistractorModel {
  Shared<std::string> name;
  Shared<std::filesystem::path> file;
  Shared<std::string> class_path;  ///< "": none
  // Of the recipe's own models: images of that split and fold alone show it.
  std::string split;
  std::optional<std::uint64_t> fold;
};

/// A pattern of materials.vary, distractors.vary or environments.vary.
struct VaryPattern {
  std::string pattern;      ///< "*.uroughness", "office/lamp.emission.gain"
  std::string environment;  ///< which: a pattern too
  std::string node, property;
  bool optional = false;  ///< "?": what has no such property is left as it is
  std::size_t drawn = 0;  ///< index of Recipe::drawn
  RecipeValue value;      ///< the distribution as the recipe has it
};

/// [distractors] of a recipe.
struct DistractorSettings {
  std::vector<DistractorModel> models;  ///< by name; none: no image shows any
  bool of_recipe = false;               ///< they are the recipe's own
  std::string folder;                   ///< else the name of theirs
  std::vector<Drawn> drawn;             ///< for each distractor: place_m, size_m, turn, vary's
  std::vector<VaryPattern> vary;        ///< of its material; `drawn` is of the list above
  double gap_m = 0;
  int tries = 0;
  bool own = false;  ///< an image's own model may be one, too
};

/// One that an image shows.
struct Distractor {
  int number = 0;  ///< from 0, those that found no place counted
  DistractorModel model;
  Shared<std::filesystem::path> material_file;  ///< the model's where its own are shown
  Shared<std::string> material_name;
  Variables values;   ///< distractor_size_m, distractor_turn, distractor_place_m
  DrawnValues draws;  ///< of DistractorSettings::drawn, in its order
  double lowest = 0;  ///< as lowest_of has it, where it tilts
  int tries = 0;      ///< places that were rejected before

  std::uint32_t id() const { return k_first_distractor_id + static_cast<std::uint32_t>(number); }
};

/// Takes what is drawn for each distractor out of what is drawn for an image.
std::vector<Drawn> take_draws_of_each(std::vector<Drawn>& drawn);
/// Reads the rest of [distractors]. Models, classes and splits must be read.
void read_distractors(Settings& settings, Recipe& recipe);

/// Those that the image is to show, not placed yet: as many as its count says, each drawn by seed, model,
/// view, key and number, so that one more moves no other. Which model and which material, by the highest
/// hash, as materials are chosen; the image's own model, and what `is_own` says of besides, is passed over for
/// the next one unless the recipe wants it. Fewer, or none, where no other model is of the image's split and
/// fold.
std::vector<Distractor> draw_distractors(
    const ImageSpec& image, const Recipe& recipe,
    const std::function<bool(const DistractorModel&)>& is_own = nullptr);
/// Draws the place of one that was rejected so often at others.
void draw_place(Distractor& distractor, const ImageSpec& image, const Recipe& recipe, int tries);

/// How a distractor is placed.
NormaliseOptions normalise_of(const Distractor& distractor, const Recipe& recipe);

/// "distractors[2].size_m".
std::string distractor_key(int number, std::string_view name);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"
#include "tracer/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace ds {

/// One picture, free of any file: what can be changed about it.
struct Subject {
  Scene scene;  ///< images loaded
  Camera camera;
  EngineSettings engine;
};

/// A choice that costs or saves time and moves the picture: a setting, or an effect left out.
struct Choice {
  std::string group;  ///< "math", "path depth", "filter", "texture filtering", "effect"
  std::string name;   ///< "fast", "8", "2 px", "lens", "light warm"
  double number = 0;  ///< path depth, filter width; 0 for the rest
  bool edits_scene = false;
  std::function<void(Subject&)> apply;
};

/// Names of the groups, in the order of the report.
inline constexpr const char* k_math_group = "math";
inline constexpr const char* k_depth_group = "path depth";
inline constexpr const char* k_filter_group = "filter";
inline constexpr const char* k_texture_filter_group = "texture filtering";
inline constexpr const char* k_effect_group = "effect";

/// The deepest path of the report: what the others' loss of light is measured against.
inline constexpr int k_deepest = 16;

/// Everything about this subject that could be chosen otherwise, beside what it has: the other
/// arithmetic; paths of 2 to 16 vertices; filters of 0 (one sharp pixel) to 6 pixels; unfiltered
/// images where a material shows one; and those of effect_choices.
std::vector<Choice> choices_for(const Subject& subject);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/choices.h"

#include "builder/measure/effect_choices.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

using Choices = std::vector<Choice>;

std::size_t as_index(int i) {
  return static_cast<std::size_t>(i);
}

void add_depths(Choices& choices) {
  for (const int depth : {2, 3, 4, 6, 8, 12, k_deepest})
    choices.push_back(
        {k_depth_group, std::to_string(depth), double(depth), false, [depth](Subject& s) {
           s.engine.depth_total = depth;
           s.engine.depth_diffuse = depth;
           s.engine.depth_glossy = depth;
           s.engine.depth_specular = depth;
         }});
}

void add_filters(Choices& choices, const EngineSettings& engine) {
  for (const float width : {0.0f, 1.5f, 2.0f, 3.0f, 4.0f, 6.0f}) {
    if (width == engine.filter_width) continue;
    choices.push_back({k_filter_group, width == 0 ? "box of 1 px" : fmt::format("{} px", width),
                       double{width}, false,
                       [width](Subject& s) { s.engine.filter_width = width; }});
  }
}

bool shows_filtered_image(const Scene& scene) {
  return std::any_of(scene.textures.begin(), scene.textures.end(), [&](const Texture& texture) {
    return texture.image >= 0 &&
           scene.images[as_index(texture.image)].filter == ImageFilter::linear;
  });
}

}  // namespace

std::vector<Choice> choices_for(const Subject& subject) {
  Choices choices;
  const bool strict = subject.engine.math == MathMode::strict;
  choices.push_back({k_math_group, strict ? "fast" : "strict", 0, false, [strict](Subject& s) {
                       s.engine.math = strict ? MathMode::fast : MathMode::strict;
                     }});
  add_depths(choices);
  add_filters(choices, subject.engine);
  if (shows_filtered_image(subject.scene))
    choices.push_back({k_texture_filter_group, "nearest texel", 0, true, [](Subject& s) {
                         for (Image& image : s.scene.images)
                           image.filter = ImageFilter::nearest;
                       }});
  for (Choice& choice : effect_choices(subject).choices)
    choices.push_back(std::move(choice));
  return choices;
}

}  // namespace ds

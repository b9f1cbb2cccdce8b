// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/draws_text.h"

#include "builder/plan/dataset_manifest.h"
#include "tracer/base/streams.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace ds {
namespace {

std::vector<const ImageSpec*> images_of(const Plan& plan) {
  std::vector<const ImageSpec*> images;
  for (const PlannedImage& image : plan.images)
    if (!image.elsewhere && !image.error) images.push_back(&image.spec);
  return images;
}

std::string numbers_text(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return fmt::format("{:.5g}", numbers.front());
  return fmt::format("[{:.4g}]", fmt::join(numbers, ", "));
}

bool draws_anything(const Recipe& recipe) {
  return !recipe.drawn.empty() || !recipe.distractors.drawn.empty();
}

/// Whether it is drawn for each distractor, and not for each image.
bool is_of_each(const Recipe& recipe, const std::string& key) {
  const std::vector<Drawn>& drawn = recipe.distractors.drawn;
  return std::any_of(drawn.begin(), drawn.end(), [&](const Drawn& one) { return one.key == key; });
}

std::size_t longest_key(const Recipe& recipe) {
  std::size_t longest = 0;
  for (const auto* drawn : {&recipe.drawn, &recipe.distractors.drawn})
    for (const Drawn& one : *drawn)
      longest = std::max(longest, one.key.size());
  return longest;
}

}  // namespace

void print_draws(const Recipe& recipe, const Plan& plan, bool each_image) {
  if (!draws_anything(recipe))
    say(Stream::result, "the recipe has no distribution: nothing is drawn\n");
  const std::vector<const ImageSpec*> images = images_of(plan);
  const std::size_t width = longest_key(recipe);
  for (const auto& [key, draw] : summaries_of(recipe, images)) {
    say(Stream::result, "{:<{}}  {}", key, width, draw.distribution);
    if (draw.count > 0)
      say(Stream::result, ": {} to {}, mean {}, of {} {}{}", numbers_text(draw.least),
          numbers_text(draw.most), numbers_text(draw.mean), draw.count,
          is_of_each(recipe, key) ? "distractor" : "image", draw.count == 1 ? "" : "s");
    say(Stream::result, "\n");
  }
  if (!each_image) return;
  for (const ImageSpec* image : images) {
    std::string text;
    for (const auto& [key, draw] : draws_of(*image, recipe))
      text += fmt::format("{} {} {}", text.empty() ? "" : ",", key, numbers_text(draw.values));
    if (!text.empty()) say(Stream::result, "{}:{}\n", image->id, text);
  }
}

nlohmann::json draws_json(const Recipe& recipe, const Plan& plan) {
  const std::vector<const ImageSpec*> images = images_of(plan);
  nlohmann::json each = nlohmann::json::object();
  if (draws_anything(recipe))
    for (const ImageSpec* image : images)
      each[image->id] = to_json_value(draws_of(*image, recipe));
  return {{"draws", to_json_value(summaries_of(recipe, images))}, {"image_draws", each}};
}

void print_draws(const Recipe& recipe, const ImageSpec& image) {
  const std::size_t width = longest_key(recipe);
  for (const auto& [key, draw] : draws_of(image, recipe))
    say(Stream::result, "drawn {:<{}}  {}\n", key, width, numbers_text(draw.values));
}

void print_rejected(const Recipe& recipe, const DrawCounts& counts) {
  if (!recipe.keep.any() || counts.draws == 0) return;
  std::uint64_t all = 0;
  std::string each;
  for (const auto& [condition, count] : counts.rejected) {
    all += count;
    each += fmt::format("{}{} {:.2g} %", each.empty() ? ": " : ", ", condition,
                        100 * static_cast<double>(count) / static_cast<double>(counts.draws));
  }
  say(Stream::result, "camera.keep rejects {} of {} draws{}\n", all, counts.draws, each);
}

nlohmann::json rejected_json(const DrawCounts& counts) {
  return {{"draws", counts.draws}, {"rejected", counts.rejected}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/plan_concerns.h"

#include "tracer/base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// A to z only: which other letters are one depends on the file system.
std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

/// Counts the files of which these are true; what was found was said when they were read.
Concern count_assets(const char* name, const std::vector<PlannedImage>& images, Inputs& inputs,
                     const std::function<bool(const Scene& material)>& of_material,
                     const std::function<bool(const fs::path& folder)>& of_environment) {
  Concern concern{name, 0, 0, {}};
  std::set<const void*> seen;  // the files' paths are long, and images many
  std::set<std::string> files;
  const auto look = [&](const Shared<fs::path>& asset, const auto& is_true) {
    if (!seen.insert(asset.identity()).second || !files.insert(asset->native()).second) return;
    ++concern.of;
    if (is_true()) add_example(concern, asset->filename().string());
  };
  for (const PlannedImage& image : images) {
    if (image.error) continue;
    const ImageSpec& spec = image.spec;
    look(spec.material_file, [&] { return of_material(inputs.material(spec)); });
    look(spec.environment_folder, [&] { return of_environment(spec.environment_folder); });
  }
  return concern;
}

bool is_unphysical(const Scene& material) {
  return std::any_of(material.materials.begin(), material.materials.end(),
                     [](const Material& part) { return !part.unphysical.empty(); });
}

}  // namespace

Concern count_damaged(const std::vector<PlannedImage>& images, Inputs& inputs) {
  Concern concern{"meshes_damaged", 0, 0, {}};
  std::set<const void*> seen;  // an environment's path is held in several places
  std::set<std::string> environments;
  Shared<fs::path> model;  // of the image before: a model's images follow each other
  for (const PlannedImage& image : images) {
    if (image.error) continue;
    const ImageSpec& spec = image.spec;
    if (!model.is_same(spec.model_file)) {
      model = spec.model_file;
      ++concern.of;
      if (loses_faces(inputs.model_damage(spec.model_file))) add_example(concern, spec.model_name);
    }
    const Shared<fs::path>& folder = spec.environment_folder;
    if (!seen.insert(folder.identity()).second || !environments.insert(folder->native()).second)
      continue;
    ++concern.of;
    if (inputs.environment_facts(folder).lost_faces) add_example(concern, spec.environment_name);
  }
  return concern;
}

Concern count_unphysical(const std::vector<PlannedImage>& images, Inputs& inputs) {
  return count_assets(
      "assets_unphysical", images, inputs, is_unphysical,
      [&](const fs::path& folder) { return inputs.environment_facts(folder).unphysical; });
}

Concern count_unlikely_assets(const Recipe& recipe, const std::vector<PlannedImage>& images,
                              Inputs& inputs) {
  return count_assets(
      "assets_unlikely", images, inputs, [](const Scene& material) { return material.unlikely; },
      [&](const fs::path& folder) {
        const EnvironmentFacts& facts = inputs.environment_facts(folder);
        const bool dark = facts.dark && recipe.lights.empty() && recipe.environment_vary.empty();
        if (dark) warn(fmt::format("{}: nothing in it gives light", folder.string()));
        return facts.unlikely || dark;
      });
}

Concern count_names_by_case(const std::vector<PlannedImage>& images) {
  std::vector<std::pair<Hash128, std::size_t>> names;
  names.reserve(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    names.emplace_back(hash_text(in_lower_case(images[i].spec.id)), i);
  std::sort(names.begin(), names.end());
  std::vector<std::size_t> concerned;
  for (std::size_t i = 0; i < names.size(); ++i)
    if ((i > 0 && names[i - 1].first == names[i].first) ||
        (i + 1 < names.size() && names[i + 1].first == names[i].first))
      concerned.push_back(names[i].second);
  std::sort(concerned.begin(), concerned.end());
  Concern concern{"names_by_case", 0, images.size(), {}};
  for (const std::size_t i : concerned)
    add_example(concern, images[i].spec.id);
  return concern;
}

Concern count_unplaced(const Recipe& recipe, const std::vector<PlannedImage>& images) {
  Concern concern{"distractors_unplaced", 0, 0, {}};
  if (recipe.distractors.models.empty()) return concern;
  for (const PlannedImage& image : images) {
    if (image.error || image.spec.variables->values.distractor_count == 0) continue;
    ++concern.of;
    if (image.spec.unplaced > 0)
      add_example(concern,
                  fmt::format("{} (of {} {})", image.spec.id,
                              image.spec.variables->values.distractor_count, image.spec.unplaced));
  }
  return concern;
}

}  // namespace ds

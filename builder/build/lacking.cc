// SPDX-License-Identifier: Apache-2.0
#include "builder/build/lacking.h"

#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace ds {
namespace {

struct Needs {
  bool uvs = false;
  std::set<std::string> seen;  ///< models
};

Needs needs_of(const Scene& material) {
  Needs needs;
  for (const Texture& texture : material.textures)
    needs.uvs = needs.uvs || reads_uvs(texture_types()[static_cast<std::size_t>(texture.type)]);
  return needs;
}

}  // namespace

std::vector<Lacking> find_lacking(const Plan& plan, Inputs& inputs) {
  std::unordered_map<std::string, Needs> needs;
  std::map<std::string, std::vector<std::string>> found;
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere || image.error) continue;
    const ImageSpec& spec = image.spec;
    auto known = needs.find(spec.material_file->native());
    if (known == needs.end())
      known =
          needs.emplace(spec.material_file->native(), needs_of(inputs.material(spec.material_file)))
              .first;
    Needs& need = known->second;
    if (!need.uvs || !need.seen.insert(spec.model_name).second) continue;
    if (!inputs.model_has_uvs(spec.model_file))
      found[spec.material_file->filename().string()].push_back(spec.model_name);
  }
  std::vector<Lacking> lacking;
  for (auto& [material, models] : found)
    lacking.push_back({material, std::move(models)});
  return lacking;
}

std::string to_text(const Lacking& lacking) {
  constexpr std::size_t k_most_named = 5;
  const std::size_t count = lacking.models.size(), named = std::min(count, k_most_named);
  std::string text =
      fmt::format("{}: its textures read uv, which {} not have: {}", lacking.material,
                  count == 1 ? "1 model does" : fmt::format("{} models do", count),
                  fmt::join(lacking.models.begin(),
                            lacking.models.begin() + static_cast<std::ptrdiff_t>(named), ", "));
  if (count > named) text += fmt::format(" and {} more", count - named);
  return text;
}

}  // namespace ds

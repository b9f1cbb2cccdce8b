// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/lacking.h"

#include "tracer/scene/scene_reads.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace ds {
namespace {

struct Needs {
  MeshExtras reads;
  std::set<std::string> seen;  ///< models
};

Needs needs_of(const Scene& material) {
  return {reads_of_model(material), {}};
}

}  // namespace

std::vector<Lacking> find_lacking(const Plan& plan, Inputs& inputs) {
  std::unordered_map<std::string, Needs> needs;
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> found;
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere || image.error) continue;
    const ImageSpec& spec = image.spec;
    auto known = needs.find(spec.material_file->native());
    if (known == needs.end())
      known = needs.emplace(spec.material_file->native(), needs_of(inputs.material(spec))).first;
    Needs& need = known->second;
    if (need.reads == MeshExtras{} || !need.seen.insert(spec.model_name).second) continue;
    const MeshExtras has = inputs.model_has(spec.model_file);
    const std::string material = spec.material_file->filename().string();
    if (need.reads.uvs && !has.uvs) found[{material, "uv"}].push_back(spec.model_name);
    if (need.reads.colors && !has.colors) found[{material, "colours"}].push_back(spec.model_name);
  }
  std::vector<Lacking> lacking;
  for (auto& [what, models] : found)
    lacking.push_back({what.first, what.second, std::move(models)});
  return lacking;
}

std::string to_text(const Lacking& lacking) {
  constexpr std::size_t k_most_named = 5;
  const std::size_t count = lacking.models.size(), named = std::min(count, k_most_named);
  std::string text =
      fmt::format("{}: its textures read {}, which {} not have: {}", lacking.material,
                  lacking.reads, count == 1 ? "1 model does" : fmt::format("{} models do", count),
                  fmt::join(lacking.models.begin(),
                            lacking.models.begin() + static_cast<std::ptrdiff_t>(named), ", "));
  if (count > named) text += fmt::format(" and {} more", count - named);
  return text;
}

}  // namespace ds

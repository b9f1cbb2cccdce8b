// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/own_notes.h"

#include "manifests/json_text.h"
#include "tracer/base/error.h"
#include "tracer/scene/mesh_text.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace ds {

Concern find_own_notes(const std::vector<PlannedImage>& images, Inputs& inputs,
                       std::vector<std::string>& lines) {
  Concern all{"own_materials_partial", 0, 0, {}};
  std::map<std::string, Concern> found;
  std::set<const void*> seen;  // files' paths are long, and images many
  std::set<std::string> files;
  const auto look = [&](const Shared<std::filesystem::path>& file, const std::string& model) {
    if (!seen.insert(file.identity()).second || !files.insert(file->native()).second) return;
    ++all.of;
    const OwnMaterials& own = inputs.own_materials(file);
    for (const auto& [name, count] : own.notes)
      add_example(found[name], model);
    if (!own.notes.empty()) add_example(all, model);
  };
  for (const PlannedImage& image : images) {
    if (image.error || !shows_own(image.spec)) continue;
    look(image.spec.model_file, image.spec.model_name);
    for (const Distractor& one : *image.spec.distractors)
      look(one.model.file, one.model.name);
  }
  for (const OwnNote& note : k_own_notes) {
    const auto at = found.find(note.name);
    if (at == found.end()) continue;
    const Concern& models = at->second;
    std::string names = fmt::format("{}", fmt::join(models.examples, ", "));
    if (models.count > models.examples.size())
      names += fmt::format(" and {} more", models.count - models.examples.size());
    lines.push_back(fmt::format("{} of {} models ({}): some of their own materials {}",
                                models.count, all.of, names, note.text));
  }
  return all;
}

std::vector<std::string> names_of(const OwnMaterials& own) {
  std::vector<std::string> names;
  for (const OwnMaterial& material : own.materials) {
    try {
      canonical_json(material.name);
      names.push_back(material.name);
    } catch (const Error&) {  // no UTF-8
      names.push_back(printable(material.name));
    }
  }
  return names;
}

}  // namespace ds

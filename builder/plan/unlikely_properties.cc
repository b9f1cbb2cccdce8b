// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/unlikely_properties.h"

#include "tracer/base/error.h"
#include "tracer/scene/scene_reads.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

namespace ds {
namespace {

class PropertyFinder {
 public:
  PropertyFinder(const Recipe& recipe, Inputs& inputs) : recipe_(recipe), inputs_(inputs) {}

  void look(const ImageSpec& spec) {
    if (!model_.is_same(spec.model_file)) {
      model_ = spec.model_file;
      unlikely_ = &inputs_.model_unlikely(spec.model_file);
      counted_ = false;
      ++all_.of;
      seen_.clear();
    }
    if (unlikely_->empty()) return;
    const MeshExtras reads = reads_of_image(spec);
    for (const auto& [name, count] : *unlikely_) {
      const MeshReportColumn& column = *mesh_report_column(name);
      const bool is_read = column.property == nullptr || reads.*column.property;
      // Of these own_notes.h tells what is not used.
      const bool is_used = column.count == &MeshReport::unused_materials && shows_own(spec);
      if (!is_read || is_used || !seen_.insert(column.name).second) continue;
      add_example(found_[column.name], spec.model_name);
      // Parts that are never read are no fault of the model: they are said, not counted.
      if (column.property != nullptr && !std::exchange(counted_, true))
        add_example(all_, spec.model_name);
    }
  }

  Concern all() && { return std::move(all_); }

  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const MeshReportColumn& column : k_mesh_report_columns) {
      const auto at = found_.find(column.name);
      if (at == found_.end()) continue;
      const Concern& models = at->second;
      std::string names = fmt::format("{}", fmt::join(models.examples, ", "));
      if (models.count > models.examples.size())
        names += fmt::format(" and {} more", models.count - models.examples.size());
      lines.push_back(fmt::format("{} of {} models ({}): some of their {} {}", models.count,
                                  all_.of, names, name_of(column), column.unlikely));
    }
    return lines;
  }

 private:
  static const char* name_of(const MeshReportColumn& column) {
    return column.property == nullptr               ? "parts"
           : column.property == &MeshExtras::colors ? "colours"
           : column.property == &MeshExtras::uvs    ? "uvs"
                                                    : "normals";
  }

  MeshExtras reads_of_image(const ImageSpec& spec) {
    const auto [at, is_new] = reads_.try_emplace(spec.material_file->native());
    if (is_new) {
      const Scene& material = inputs_.material(spec);
      at->second = reads_of_model(material);
    }
    MeshExtras reads = at->second;
    reads.normals = recipe_.normalise.normals == Normals::keep;
    return reads;
  }

  const Recipe& recipe_;
  Inputs& inputs_;
  Concern all_{"models_unlikely", 0, 0, {}};
  Shared<std::filesystem::path> model_;  // of the image before: a model's images follow each other
  const MendedDamage* unlikely_ = nullptr;
  std::set<std::string> seen_;  ///< what was found of the model
  bool counted_ = false;
  std::map<std::string, MeshExtras> reads_;
  std::map<std::string, Concern> found_;  ///< models, by column
};

}  // namespace

Concern find_unlikely_properties(const Recipe& recipe, const std::vector<PlannedImage>& images,
                                 Inputs& inputs, std::vector<std::string>& lines) {
  PropertyFinder finder(recipe, inputs);
  for (const PlannedImage& image : images)
    if (!image.error) finder.look(image.spec);
  for (std::string& line : finder.lines())
    lines.push_back(std::move(line));
  return std::move(finder).all();
}

}  // namespace ds

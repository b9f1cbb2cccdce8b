// SPDX-License-Identifier: Apache-2.0
#include "builder/build/plan.h"

#include "builder/build/limits.h"
#include "builder/build/manifest_state.h"
#include "builder/build/placed_files.h"

#include <algorithm>

namespace ds {
namespace {

/// Reasons named in full; what follows is counted.
constexpr std::size_t k_most_changes = 4;

class Planner {
 public:
  Planner(Dataset& dataset, TextSet& texts, bool force, Stamps stamps)
      : dataset_(dataset),
        database_(*dataset.database),
        texts_(texts),
        force_(force),
        known_(database_.images(dataset.row.id)),
        placed_(dataset, stamps) {}

  void plan(PlannedImage& image);
  PlacedFiles& placed() { return placed_; }

 private:
  bool in_store(Hash128 key);
  void plan_files(PlannedImage& image, bool changed);
  void find_kept(PlannedImage& image);
  void add_changes(PlannedImage& image, const PartHashes& before);
  void check_known_picture(PlannedImage& image);

  Dataset& dataset_;
  Database& database_;
  TextSet& texts_;
  bool force_;
  std::map<std::string, PartHashes> known_;
  PlacedFiles placed_;
};

bool Planner::in_store(Hash128 key) {
  if (!dataset_.store) return false;
  const std::optional<Product> product = database_.find_product(key);
  return product && dataset_.store->has(product->object);
}

void Planner::add_changes(PlannedImage& image, const PartHashes& before) {
  const auto changes = changes_since(image, before, texts_, database_);
  for (std::size_t i = 0; i < std::min(changes.size(), k_most_changes); ++i)
    image.reasons.push_back(
        fmt::format("{} changed: {}", changes[i].first, to_string(changes[i].second)));
  if (changes.size() > k_most_changes)
    image.reasons.push_back(fmt::format("and {} more changes", changes.size() - k_most_changes));
}

/// The kept film that tracing can go on from.
void Planner::find_kept(PlannedImage& image) {
  if (force_ || !dataset_.recipe.keep_sums || !in_store(image.keys.kept)) return;
  const std::uint64_t samples = database_.find_product(image.keys.kept)->facts.samples;
  // Of another number of samples it is started anew; with an error target the tracer decides.
  if (samples <= image.samples()) image.kept_samples = samples;
}

void Planner::plan_files(PlannedImage& image, bool changed) {
  for (const OutputFile& output : image.keys.outputs) {
    PlannedFile file{output, FileState::in_place};
    const std::string reason = placed_.why_not_in_place(image.spec.id, output);
    if (!reason.empty() || force_) {
      // Where a property changed, that is the reason, and the files of older keys follow from it.
      if (!reason.empty() && !changed) image.reasons.push_back(reason);
      file.state = !force_ && in_store(output.key) ? FileState::in_store : FileState::to_make;
    }
    if (file.state == FileState::to_make) {
      if (output.kind != "image")
        image.trace_geometry = true;
      else if (force_ || !in_store(image.keys.render))
        image.trace_film = true;
    }
    image.files.push_back(std::move(file));
  }
  if (image.trace_film) find_kept(image);
}

/// A picture that was traced and refused is not traced again: it fails as it did.
void Planner::check_known_picture(PlannedImage& image) {
  if (force_) return;
  for (const OutputFile& output : image.keys.outputs) {
    if (output.kind != "image") continue;
    const std::optional<Product> known = database_.find_product(output.key);
    if (!known) continue;
    image.refused = true;
    check_limits(dataset_.recipe, image.spec, *known);
    image.refused = false;
  }
}

void Planner::plan(PlannedImage& image) {
  check_known_picture(image);
  if (image.elsewhere) return;
  const auto known = known_.find(image.spec.id);
  const bool changed = known != known_.end() && known->second != image.keys.parts;
  if (force_) image.reasons.emplace_back("forced");
  if (known == known_.end()) image.reasons.emplace_back("new");
  if (changed) add_changes(image, known->second);
  plan_files(image, changed || known == known_.end());
  const auto in_place = [](const PlannedFile& file) { return file.state == FileState::in_place; };
  if (std::all_of(image.files.begin(), image.files.end(), in_place)) {
    // Only the record is behind: an output was switched off, or a database was lost.
    image.record = !image.reasons.empty();
    image.reasons.clear();
  }
  const bool lost_film =
      known != known_.end() && known->second == image.keys.parts && image.trace_film && !force_;
  if (lost_film) image.reasons.emplace_back("its film is not in the store");
}

}  // namespace

std::uint64_t PlannedImage::samples() const {
  return static_cast<std::uint64_t>(spec.engine.width) *
             static_cast<std::uint64_t>(spec.engine.height) *
             static_cast<std::uint64_t>(spec.engine.target ? spec.engine.target->max_spp
                                                           : spec.engine.spp) -
         kept_samples;
}

Plan make_plan(Dataset& dataset, Inputs& inputs, bool force, Shard shard) {
  Plan plan;
  KeyMaker keys(dataset.recipe, inputs, plan.texts);
  Planner planner(dataset, plan.texts, force, inputs.stamps());
  for (ImageSpec& spec : expand(dataset.recipe)) {
    PlannedImage image;
    image.elsewhere = !shard.holds(spec.id);
    image.spec = std::move(spec);
    try {
      if (dataset.recipe.camera_fit)
        fit_image(image.spec, dataset.recipe,
                  inputs.model_sphere(image.spec.model_file, dataset.recipe.normalise));
      if (image.spec.engine.target)
        image.spec.engine.target->tone_map =
            tone_map_of(dataset.recipe, inputs.environment(image.spec.environment_folder));
      image.keys = keys.keys(image.spec);
      if (const MendedDamage& damage = inputs.model_damage(image.spec.model_file); !damage.empty())
        plan.mended.try_emplace(image.spec.model_name, image.spec.model_file, damage);
      planner.plan(image);
    } catch (const DamagedDatabase&) {
      throw;
    } catch (const Error& error) {
      PlannedImage failed;
      failed.spec = std::move(image.spec);
      failed.elsewhere = image.elsewhere;
      failed.refused = image.refused;
      if (image.refused) failed.keys = std::move(image.keys);
      failed.error = error;
      image = std::move(failed);
    }
    plan.images.push_back(std::move(image));
  }
  plan.to_remove = planner.placed().left_over(plan.images, shard);
  plan.manifest = manifest_state(dataset, plan, planner.placed());
  inputs.remember();
  planner.placed().remember_stamps();
  return plan;
}

std::vector<std::pair<std::string, PropertyChange>> changes_since(const PlannedImage& image,
                                                                  const PartHashes& before,
                                                                  const TextSet& texts,
                                                                  Database& database) {
  std::vector<std::pair<std::string, PropertyChange>> changes;
  for (std::size_t i = 0; i < k_part_count; ++i) {
    const Hash128 after = image.keys.parts[i];
    if (before[i] == after) continue;
    const std::string* new_text = texts.find(after);
    DS_ASSERT(new_text != nullptr);
    const std::optional<std::string> old_text = database.find_text(before[i]);
    if (!old_text) {
      changes.push_back({k_part_names[i], {"text", before[i].hex(), after.hex()}});
      continue;
    }
    for (PropertyChange& change : diff_texts(*old_text, *new_text))
      changes.push_back({k_part_names[i], std::move(change)});
  }
  return changes;
}

}  // namespace ds

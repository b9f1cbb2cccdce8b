// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/plan.h"

#include "builder/plan/distractors.h"
#include "builder/plan/environment_vary.h"
#include "builder/plan/hash_index.h"
#include "builder/plan/idle_draws.h"
#include "builder/plan/image_material.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/licence_files.h"
#include "builder/plan/limits.h"
#include "builder/plan/manifest_state.h"
#include "builder/plan/own_notes.h"
#include "builder/plan/placed_files.h"
#include "builder/plan/plan_concerns.h"
#include "builder/plan/unlikely_properties.h"
#include "builder/plan/unlikely_sizes.h"
#include "tracer/base/log.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/plane_file.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Reasons named in full; what follows is counted.
constexpr std::size_t k_most_changes = 4;

class Planner {
 public:
  Planner(Dataset& dataset, KeyMaker& keys, TextSet& texts, bool force, Wanted wanted,
          Stamps stamps)
      : dataset_(dataset),
        database_(*dataset.database),
        keys_(keys),
        texts_(texts),
        force_(force),
        wanted_(wanted),
        placed_(std::make_shared<PlacedFiles>(dataset, stamps)),
        rejected_(database_.pictures_with_rejected()) {
    known_.reserve(image_count(dataset.recipe));
    database_.visit_images(dataset.row.id, [&](std::string_view id, const PartHashes& parts) {
      known_.push_back({hash_text(id), parts, false});
    });
    by_id_ = HashIndex(known_.size(), [&](std::size_t i) { return known_[i].id; });
    std::sort(rejected_.begin(), rejected_.end());
  }

  /// `known`: what `want` gave.
  void plan(PlannedImage& image, const PartHashes* known);
  /// Notes that the recipe has such an image, and gives what the database has of it.
  const PartHashes* want(const std::string& id);
  /// Whether the database knows images that nobody wanted.
  bool forgets() const;
  const std::shared_ptr<PlacedFiles>& placed() { return placed_; }

 private:
  /// What the database has of an image, by the hash of its id.
  struct Known {
    Hash128 id;
    PartHashes parts;
    bool wanted = false;
  };
  bool in_store(Hash128 key);
  std::string why_not_there(const PlannedImage& image, const OutputFile& output);
  bool all_there(const PlannedImage& image);
  void plan_files(PlannedImage& image, bool changed);
  void find_kept(PlannedImage& image);
  void add_changes(PlannedImage& image, const PartHashes& before);
  void check_known_picture(PlannedImage& image);

  Dataset& dataset_;
  Database& database_;
  KeyMaker& keys_;
  TextSet& texts_;
  bool force_;
  Wanted wanted_;
  std::vector<Known> known_;
  HashIndex by_id_;
  std::shared_ptr<PlacedFiles> placed_;
  std::vector<Hash128> rejected_;  ///< ascending
};

const PartHashes* Planner::want(const std::string& id) {
  const auto row = by_id_.find(hash_text(id), [&](std::size_t i) { return known_[i].id; });
  if (!row) return nullptr;
  known_[*row].wanted = true;
  return &known_[*row].parts;
}

bool Planner::forgets() const {
  return std::any_of(known_.begin(), known_.end(),
                     [](const Known& known) { return !known.wanted; });
}

bool Planner::in_store(Hash128 key) {
  if (!dataset_.store) return false;
  const std::optional<Product> product = database_.find_product(key);
  return product && dataset_.store->has(product->object);
}

/// Empty where the output is where it is wanted.
std::string Planner::why_not_there(const PlannedImage& image, const OutputFile& output) {
  if (wanted_ == Wanted::files) return placed_->why_not_in_place(image.spec.id, output);
  return in_store(output.key) ? "" : fmt::format("{} is not in the store", output.path);
}

bool Planner::all_there(const PlannedImage& image) {
  return std::all_of(
      image.keys.outputs.begin(), image.keys.outputs.end(),
      [&](const OutputFile& output) { return why_not_there(image, output).empty(); });
}

void Planner::add_changes(PlannedImage& image, const PartHashes& before) {
  const auto changes = changes_since(image, before, texts_, database_);
  for (std::size_t i = 0; i < std::min(changes.size(), k_most_changes); ++i)
    image.reasons.push_back(
        fmt::format("{} changed: {}", changes[i].first, to_string(changes[i].second)));
  if (changes.size() > k_most_changes)
    image.reasons.push_back(fmt::format("and {} more change{}", changes.size() - k_most_changes,
                                        changes.size() == k_most_changes + 1 ? "" : "s"));
}

/// The kept film that tracing can go on from.
void Planner::find_kept(PlannedImage& image) {
  if (force_ || !in_store(image.keys.kept)) return;
  const std::uint64_t samples = database_.find_product(image.keys.kept)->facts.samples;
  // Of another number of samples it is started anew; with an error target the tracer decides.
  if (samples <= image.samples()) image.kept_samples = samples;
}

void Planner::plan_files(PlannedImage& image, bool changed) {
  for (const OutputFile& output : image.keys.outputs) {
    PlannedFile file{output, FileState::in_place};
    const std::string reason = why_not_there(image, output);
    if (!reason.empty() || force_) {
      // Where a property changed, that is the reason, and the files of older keys follow from it.
      if (!reason.empty() && !changed) image.reasons.push_back(reason);
      file.state = !force_ && in_store(output.key) ? FileState::in_store : FileState::to_make;
    }
    if (file.state == FileState::to_make) {
      if (output.plane != nullptr)
        (is_of_light(*output.plane) ? image.trace_light : image.trace_planes) = true;
      else if (force_ || !in_store(image.keys.render))
        image.trace_film = true;
    }
    image.files.push_back(std::move(file));
  }
  const auto in_place = [](const PlannedFile& file) { return file.state == FileState::in_place; };
  if (!dataset_.recipe.keep_sums || std::all_of(image.files.begin(), image.files.end(), in_place))
    return;
  image.keys.kept = keys_.kept_key(image.spec, image.keys);
  if (image.trace_film && !image.trace_light) find_kept(image);
}

/// A picture that was traced and refused is not traced again: it fails as it did.
void Planner::check_known_picture(PlannedImage& image) {
  if (force_) return;
  for (const OutputFile& output : image.keys.outputs) {
    if (output.kind != "image") continue;
    // No limit is below no rejected sample.
    if (!std::binary_search(rejected_.begin(), rejected_.end(), output.key)) continue;
    const std::optional<Product> known = database_.find_product(output.key);
    if (!known) continue;
    image.refused = true;
    check_limits(dataset_.recipe, image.spec, *known);
    image.refused = false;
  }
}

void Planner::plan(PlannedImage& image, const PartHashes* known) {
  check_known_picture(image);
  if (image.elsewhere) return;
  const bool changed = known != nullptr && *known != image.keys.parts;
  const bool as_known = known != nullptr && !changed;
  if (as_known && !force_ && all_there(image)) return;
  keys_.add_texts(image.spec, image.keys);
  if (force_) image.reasons.emplace_back("forced");
  if (known == nullptr) image.reasons.emplace_back("new");
  if (changed) add_changes(image, *known);
  plan_files(image, !as_known);
  const auto in_place = [](const PlannedFile& file) { return file.state == FileState::in_place; };
  if (std::all_of(image.files.begin(), image.files.end(), in_place)) {
    // Only the record is behind: an output was switched off, or a database was lost.
    image.record = !image.reasons.empty();
    image.reasons.clear();
  }
  if (as_known && image.trace_film && !force_)
    image.reasons.emplace_back("its film is not in the store");
}

/// Else it would be found when the image is traced and cannot be put into its folder.
void check_names(const std::vector<OutputFile>& outputs) {
  constexpr std::size_t k_longest_name = 255;  // NAME_MAX of Linux's file systems
  for (const OutputFile& output : outputs) {
    const std::size_t bytes = output.path.size() - (output.path.rfind('/') + 1);
    if (bytes > k_longest_name)
      fail(ErrorKind::recipe, "{}: its name must be of at most {} bytes, got {}", output.path,
           k_longest_name, bytes);
  }
}

std::vector<std::string> edited_files(const Plan& plan) {
  std::vector<std::string> edited;
  const auto look = [&](const std::string& path) {
    if (plan.placed->find_there(path) == PlacedFiles::Found::edited) edited.push_back(path);
  };
  for (const PlannedImage& image : plan.images)
    for (const PlannedFile& file : image.files)
      if (file.state != FileState::in_place) look(file.output.path);
  for (const std::string& path : plan.to_remove)
    look(path);
  // Of a database that was lost, the manifest that stands is a build's all the same.
  for (const char* path : k_manifest_files)
    if (plan.placed->find(path) != nullptr) look(path);
  return edited;
}

/// Said of the model, by each of its images alike: no image of it can be made.
void check_normals(const Recipe& recipe, Inputs& inputs, const fs::path& model) {
  if (recipe.normalise.normals == Normals::keep && !inputs.model_has(model).normals)
    fail(
        ErrorKind::asset,
        "{}: has no normals to keep (models.normals = \"keep\"): \"smooth\" or \"flat\" makes them",
        model.string());
}

/// Throws Error(asset) for an id that the plane's file cannot hold, whether or not the image shows it.
void check_ids(const Recipe& recipe, Inputs& inputs, const ImageSpec& spec) {
  const auto check = [&](const PlaneOutput& plane, const fs::path& of, const char* property,
                         std::uint32_t id) {
    const std::uint32_t most = largest_id(plane.encoding);
    if (id > most)
      fail(ErrorKind::asset,
           "{}: {} must be at most {} for the plane {} as {}, got {}; give it a smaller id",
           of.string(), property, most, plane.type->name, name_of(plane.encoding), id);
  };
  for (const PlaneOutput& plane : recipe.outputs.planes) {
    if ((plane.type->traits & kernels::k_plane_words) == 0) continue;
    const EnvironmentFacts& around = inputs.environment_facts(spec.environment_folder);
    if ((plane.type->traits & kernels::k_plane_objects) != 0)
      check(plane, spec.environment_folder, "scene.objects.NAME.id", around.largest_object_id);
    if ((plane.type->traits & kernels::k_plane_material_ids) == 0) continue;
    check(plane, spec.environment_folder, "scene.materials.NAME.id", around.largest_material_id);
    check(plane, spec.material_file, "scene.materials.NAME.id",
          largest_material_id(inputs.material(spec)));
  }
  const std::uint32_t most = inputs.environment_facts(spec.environment_folder).largest_object_id;
  if (!recipe.distractors.models.empty() && most >= k_first_distractor_id)
    fail(ErrorKind::asset,
         "{}: scene.objects.NAME.id must be below {} where there are distractors, whose ids follow "
         "from there, got {}",
         spec.environment_folder->string(), k_first_distractor_id, most);
}

/// What must hold of distractors, which are known once the image is settled.
void check_distractors(const Recipe& recipe, Inputs& inputs, const ImageSpec& spec) {
  for (const Distractor& one : *spec.distractors) {
    check_normals(recipe, inputs, one.model.file);
    for (const PlaneOutput& plane : recipe.outputs.planes) {
      if ((plane.type->traits & kernels::k_plane_material_ids) == 0) continue;
      const std::uint32_t most = largest_id(plane.encoding),
                          id = largest_material_id(material_file_of(one, inputs));
      if (id > most)
        fail(ErrorKind::asset, "{}: its materials' ids must be at most {} for the plane {}, got {}",
             one.material_file->string(), most, plane.type->name, id);
    }
  }
}

/// Puts what the manifest says of a model's file into the plan.
void note_model(Plan& plan, Inputs& inputs, const std::string& name, const fs::path& file,
                bool shows_own) {
  const MendedDamage& damage = inputs.model_damage(file);
  if (!damage.empty()) plan.mended.try_emplace(name, MendedModel{file, damage});
  plan.extents.try_emplace(file.native(), inputs.model_extent(file));
  if (shows_own) plan.own_materials.try_emplace(name, names_of(inputs.own_materials(file)));
}

std::set<std::string> classes_of(const std::vector<PlannedImage>& images) {
  std::set<std::string> paths;
  const Shared<std::string>* before = nullptr;
  for (const PlannedImage& image : images) {
    const Shared<std::string>& path = image.spec.class_path;
    if (before == nullptr || !before->is_same(path)) paths.insert(*path);
    before = &path;
    for (const Distractor& one : *image.spec.distractors)
      paths.insert(*one.model.class_path);
  }
  return paths;
}

}  // namespace

std::uint64_t PlannedImage::samples() const {
  return static_cast<std::uint64_t>(spec.engine.width) *
             static_cast<std::uint64_t>(spec.engine.height) *
             static_cast<std::uint64_t>(spec.engine.target ? spec.engine.target->max_spp
                                                           : spec.engine.spp) -
         kept_samples;
}

namespace {

/// What an image changes of its environment stands beside its camera, which other images do not
/// share either.
std::pair<std::string, PropertyChange> of_its_part(const char* part, PropertyChange change) {
  constexpr std::string_view k_of_environment = "environments.";
  if (change.name.starts_with("distractors[")) return {"distractors", std::move(change)};
  constexpr std::string_view k_lights = "lights.lights[";
  if (part == std::string_view("camera") && change.name.starts_with(k_lights))
    return {"lights", {change.name.substr(sizeof "lights." - 1), change.before, change.after}};
  if (!change.name.starts_with(k_of_environment)) return {part, std::move(change)};
  change.name.erase(0, k_of_environment.size());
  return {"environment", std::move(change)};
}

}  // namespace

namespace {

/// The manifest, and what somebody changed in the dataset's folder.
void look_at_folder(Dataset& dataset, Plan& plan) {
  plan.labels = labels_of(dataset.recipe, plan);
  plan.manifest = manifest_state(dataset, plan, *plan.placed);
  plan.edited = edited_files(plan);
}

}  // namespace

Plan make_plan(Dataset& dataset, Inputs& inputs, bool force, Shard shard, Wanted wanted) {
  check_licensed(dataset.recipe);
  check_vary(dataset.recipe, inputs);
  check_environment_vary(dataset.recipe, inputs);
  Plan plan;
  plan.data_version = dataset.database->data_version();
  std::optional<Snapshot> snapshot(std::in_place, dataset.database->connection());
  KeyMaker keys(dataset.recipe, inputs, plan.texts);
  Planner planner(dataset, keys, plan.texts, force, wanted, inputs.stamps());
  plan.images.reserve(image_count(dataset.recipe));
  ImageSettler settler(dataset.recipe, inputs);
  Shared<std::filesystem::path> model;  // of the image before: a model's images follow each other
  expand(dataset.recipe, [&](ImageSpec&& spec) {
    PlannedImage image;
    image.elsewhere = !shard.holds(spec.id);
    const PartHashes* known = planner.want(spec.id);
    image.spec = std::move(spec);
    try {
      check_normals(dataset.recipe, inputs, image.spec.model_file);
      check_ids(dataset.recipe, inputs, image.spec);
      settler.settle(image.spec);
      check_distractors(dataset.recipe, inputs, image.spec);
      if (image.spec.engine.target)
        image.spec.engine.target->tone_map =
            tone_map_of(dataset.recipe, inputs.environment_facts(image.spec.environment_folder));
      image.keys = keys.keys(image.spec);
      check_names(image.keys.outputs);
      if (!model.is_same(image.spec.model_file)) {
        note_model(plan, inputs, image.spec.model_name, image.spec.model_file,
                   shows_own(image.spec));
        if (const std::string& shape = inputs.model_shape(image.spec.model_file); !shape.empty())
          plan.shapes.try_emplace(image.spec.model_name, shape);
        model = image.spec.model_file;
      }
      for (const Distractor& one : *image.spec.distractors)
        if (!plan.extents.contains(one.model.file->native()))
          note_model(plan, inputs, one.model.name, one.model.file,
                     one.material_file.is_same(one.model.file));
      planner.plan(image, known);
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
  });
  plan.drawn = settler.counts();
  plan.class_ids = class_ids(dataset.recipe, classes_of(plan.images));
  plan.placed = planner.placed();
  if (wanted == Wanted::files) {
    plan.to_remove = plan.placed->left_over(plan.images, shard);
    plan.forgets = planner.forgets();
  }
  std::vector<std::string> unlikely;
  plan.concerns = {count_unphysical(plan.images, inputs),
                   count_unlikely_assets(dataset.recipe, plan.images, inputs),
                   find_unlikely_sizes(dataset.recipe, plan.images, inputs, unlikely),
                   count_names_by_case(plan.images),
                   count_damaged(plan.images, inputs),
                   find_unlikely_properties(dataset.recipe, plan.images, inputs, unlikely),
                   find_own_notes(plan.images, inputs, unlikely),
                   count_unplaced(dataset.recipe, plan.images),
                   find_idle_draws(dataset.recipe, plan.images, inputs)};
  for (const std::string& line : unlikely)
    warn(line);
  snapshot.reset();
  if (wanted == Wanted::files) look_at_folder(dataset, plan);
  inputs.remember();
  plan.placed->remember_stamps();
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
      changes.push_back(of_its_part(k_part_names[i], std::move(change)));
  }
  return changes;
}

}  // namespace ds

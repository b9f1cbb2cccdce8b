// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/manifest_state.h"

#include "builder/plan/dataset_manifest.h"
#include "manifests/manifest_glance.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_images_file = k_manifest_files[0];
constexpr const char* k_dataset_file = k_manifest_files[1];
constexpr const char* k_checksums_file = k_manifest_files[2];

/// Settings and licences named in full; what follows is counted.
constexpr std::size_t k_most_named = 4;

/// What a line of images.jsonl says of an image besides what its keys tell.
struct Label {
  const char* name;
  std::string_view LineGlance::*recorded;
  Shared<std::string> ImageSpec::*wanted;
  bool of_model;  ///< holds of images too that cannot be made now
};
constexpr Label k_labels[] = {
    {"class_path", &LineGlance::class_path, &ImageSpec::class_path, true},
    {"split", &LineGlance::split, &ImageSpec::split, true},
    {"material", &LineGlance::material, &ImageSpec::material_name, false},
    {"environment", &LineGlance::environment, &ImageSpec::environment_name, false},
};

/// dataset.json but for what counts the images.
DatasetRecord description(const Recipe& recipe, const Plan& plan) {
  DatasetRecord record = dataset_record(recipe, plan, {});
  for (const auto& [model, what] : plan.mended)
    record.mended_models.emplace_back(model, what.damage);
  record.shapes = plan.shapes;
  record.own_materials = plan.own_materials;
  return record;
}

void add_word(HashStream& hash, const std::string& word) {
  hash.add({word.c_str(), word.size() + 1});  // its end is the mark between it and the next
}

Hash128 hash_of_labels(DatasetRecord record, const Plan& plan) {
  record.dsbuild_version.clear();
  HashStream hash;
  hash.add(to_json(record));
  for (const PlannedImage& image : plan.images) {
    add_word(hash, image.spec.id);
    for (const Label& label : k_labels)
      add_word(hash, *(image.spec.*label.wanted));
    for (const auto& [hierarchy, path] : *image.spec.other_classes)
      add_word(hash, path);
    if (image.spec.fold) add_word(hash, std::to_string(*image.spec.fold));
    for (const Distractor& one : *image.spec.distractors)
      for (const auto* word : {&one.model.name, &one.model.class_path, &one.material_name})
        add_word(hash, **word);
  }
  return hash.hash();
}

/// As where older lines are taken over: a file that cannot be read is not known to be what a line says.
Hash128 bytes_in_place(const PlacedFiles& placed, const std::string& path) {
  try {
    return placed.bytes_in_place(path).value_or(Hash128{});
  } catch (const DiskFailed&) {
    throw;
  } catch (const Error&) {
    return {};
  }
}

/// What decides which lines are taken over from the manifest before.
void add_older(HashStream& listing, const ListedImages& images, const PlacedFiles& placed) {
  if (images.lacking.empty()) return;
  add_word(listing, "older");
  auto pending = images.pending.begin();
  for (const PlannedImage* image : images.lacking) {
    const bool is_pending = pending != images.pending.end() && *pending == image;
    if (is_pending) ++pending;
    add_word(listing, image->spec.id);
    add_word(listing, image->refused ? "refused" : is_pending ? "pending" : "");
    if (image->refused) continue;
    // A line may have files that the recipe no longer asks for.
    for (const std::string& ending : all_output_endings())
      listing.add(bytes_in_place(placed, output_path(image->spec.id, ending)));
  }
}

/// Empty where the file stands as it was written.
std::string why_not_as_written(const Dataset& dataset, const char* path,
                               const PlacedFiles& placed) {
  const PlacedFiles::Row* known = placed.find(path);
  if (known == nullptr) return fmt::format("{} was never written", path);
  const fs::path file = dataset.folder / path;
  const std::optional<FileStamp> stamp = stamp_of(file);
  if (!stamp) return fmt::format("{} is missing", path);
  if (stamp != known->stamp && content_hash(file) != known->object)
    return fmt::format("{} was changed on the disk", path);
  return "";
}

bool written_from(const PlacedFiles& placed, const char* path, Hash128 source) {
  const PlacedFiles::Row* known = placed.find(path);
  return known != nullptr && known->product == source;
}

std::string change(std::string_view before, std::string_view after) {
  const auto shown = [](std::string_view text) { return text.empty() ? "none" : text; };
  return fmt::format("{} -> {}", shown(before), shown(after));
}

/// How many images a word of the manifest is no longer true of.
struct Changes {
  std::size_t count = 0;
  std::string first{};  ///< "mug/3: train -> test", of the first

  void tell(const char* name, std::vector<std::string>& behind) const {
    if (count == 0) return;
    behind.push_back(fmt::format("{} of {} image{}{}", name, count, count == 1 ? "" : "s",
                                 first.empty() ? "" : " (" + first + ")"));
  }
};

void compare_images(const Plan& plan, const fs::path& folder, std::vector<std::string>& behind) {
  std::map<std::string_view, const PlannedImage*> by_id;
  for (const PlannedImage& image : plan.images)
    by_id.emplace(image.spec.id, &image);
  std::array<Changes, std::size(k_labels)> labels;
  Changes more, folds;
  visit_glances(folder, [&](const LineGlance& line) {
    const auto at = by_id.find(line.id);
    if (at == by_id.end() || at->second->stale()) return;
    const PlannedImage& image = *at->second;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (image.error && !k_labels[i].of_model) continue;
      const std::string_view before = line.*k_labels[i].recorded;
      const std::string& after = *(image.spec.*k_labels[i].wanted);
      if (before == after || labels[i].count++ > 0) continue;
      labels[i].first = fmt::format("{}: {}", image.spec.id, change(before, after));
    }
    if (line.other_classes != other_classes_text(*image.spec.other_classes)) ++more.count;
    if (line.fold != image.spec.fold) ++folds.count;
  });
  for (std::size_t i = 0; i < labels.size(); ++i)
    labels[i].tell(k_labels[i].name, behind);
  more.tell("classes.more", behind);
  folds.tell("fold", behind);
}

/// "licences: models/a.off, models/b.off and 3 more"
void add_named(std::vector<std::string>& behind, const char* what,
               const std::vector<std::string>& names) {
  if (names.empty()) return;
  const auto shown =
      names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), k_most_named));
  std::string text = fmt::format("{}: {}", what, fmt::join(names.begin(), shown, ", "));
  if (names.size() > k_most_named) text += fmt::format(" and {} more", names.size() - k_most_named);
  behind.push_back(std::move(text));
}

template <typename Pairs>
std::map<std::string, typename Pairs::value_type::second_type> to_map(const Pairs& pairs) {
  return {pairs.begin(), pairs.end()};
}

/// Keys that one map has and the other has not, or with another value.
template <typename Value>
std::vector<std::string> differing(const std::map<std::string, Value>& before,
                                   const std::map<std::string, Value>& after) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : after)
    if (const auto old = before.find(key); old == before.end() || old->second != value)
      keys.push_back(key);
  for (const auto& [key, value] : before)
    if (!after.contains(key)) keys.push_back(key);
  return keys;
}

/// The lines "section.key = value" of a canonical recipe.
std::map<std::string, std::string> settings_of(const std::string& recipe_text) {
  std::map<std::string, std::string> settings;
  std::istringstream lines(recipe_text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t middle = line.find(" = ");
    if (middle != std::string::npos)
      settings.emplace(line.substr(0, middle), line.substr(middle + 3));
  }
  return settings;
}

/// Of licences or sources, by asset.
template <typename Records>
std::map<std::string, std::string> texts_of(const Records& records) {
  std::map<std::string, std::string> texts;
  for (const auto& record : records)
    for (const std::string& asset : record.assets)
      texts[asset] += record.text;
  return texts;
}

std::map<std::string, std::size_t> class_ids(const DatasetRecord& record) {
  std::map<std::string, std::size_t> ids;
  for (const std::string& path : record.class_paths)
    ids.emplace(path, ids.size());
  return ids;
}

/// What the labels tell; the rest is counted from images.
void compare_concerns(std::vector<Concern> before, std::vector<Concern> after,
                      std::vector<std::string>& behind) {
  if (before.empty()) {
    behind.emplace_back("concerns: not counted by the version that wrote it");
    return;
  }
  for (const char* name :
       {"models_absent", "models_unlisted", "classes_unshared", "assets_unphysical",
        "assets_unlikely", "sizes_unlikely", "names_by_case", "meshes_damaged", "models_unlikely",
        "own_materials_partial", "distractors_unplaced"}) {
    const std::uint64_t old_count = concern(before, name).count;
    const std::uint64_t new_count = concern(after, name).count;
    if (old_count != new_count)
      behind.push_back(fmt::format("concerns.{}: {} -> {}", name, old_count, new_count));
  }
}

/// Of each model what was mended, in no order: JSON keeps another than readers of meshes.
std::map<std::string, std::map<std::string, std::uint64_t>> mended_models(
    const DatasetRecord& dataset) {
  std::map<std::string, std::map<std::string, std::uint64_t>> models;
  for (const auto& [model, damage] : dataset.mended_models)
    models.emplace(model, to_map(damage));
  return models;
}

void compare_datasets(const DatasetRecord& before, const DatasetRecord& after,
                      std::vector<std::string>& behind) {
  if (before.name != after.name) behind.push_back("name: " + change(before.name, after.name));
  if (before.licence != after.licence)
    behind.push_back("licence: " + change(before.licence, after.licence));
  add_named(behind, "licence texts",
            differing(texts_of(before.licences), texts_of(after.licences)));
  add_named(behind, "sources", differing(texts_of(before.sources), texts_of(after.sources)));
  add_named(behind, "class ids", differing(class_ids(before), class_ids(after)));
  add_named(behind, "shapes", differing(before.shapes, after.shapes));
  add_named(behind, "own materials", differing(before.own_materials, after.own_materials));
  add_named(behind, "mended models", differing(mended_models(before), mended_models(after)));
  compare_concerns(before.concerns, after.concerns, behind);
  std::vector<std::string> settings =
      differing(settings_of(before.recipe_text), settings_of(after.recipe_text));
  std::erase_if(settings,
                [](const auto& key) { return key == "dataset.name" || key == "dataset.licence"; });
  add_named(behind, "settings", settings);
}

/// What writes the manifest.
Hash128 hash_of_program() {
  return hash_text(fmt::format("{} {}", program_version(), k_manifest_fields));
}

/// The version that wrote the manifest, where that is another one.
std::string older_program(const fs::path& folder) {
  try {
    std::string version = read_dataset_manifest(folder).dsbuild_version;
    return version == program_version() ? version + " without fields there are now" : version;
  } catch (const Error&) {
    return "an unknown version";
  }
}

/// What in the manifest differs from the plan, but for images that are to be made.
std::vector<std::string> differences(const Dataset& dataset, const Plan& plan, bool any_stale) {
  std::vector<std::string> behind;
  try {
    compare_images(plan, dataset.folder, behind);
    // A recipe whose images are to be made is another one: that is said of them.
    if (!any_stale)
      compare_datasets(read_dataset_manifest(dataset.folder), description(dataset.recipe, plan),
                       behind);
  } catch (const Error& error) {
    behind.emplace_back(error.what());
  }
  return behind;
}

}  // namespace

PlanLabels labels_of(const Recipe& recipe, const Plan& plan) {
  try {
    return {hash_of_labels(description(recipe, plan), plan), std::nullopt};
  } catch (const Error& error) {
    return {hash_text(error.what()), error};
  }
}

ManifestSources manifest_sources(const Plan& plan, const ListedImages& images,
                                 const PlacedFiles& placed) {
  if (plan.labels.error) throw *plan.labels.error;
  ManifestSources sources{{}, plan.labels.hash, hash_of_program()};
  HashStream listing;
  listing.add(sources.labels);
  for (const PlannedImage* image : images.made) {
    add_word(listing, image->spec.id);
    listing.add(image->keys.render);
    for (const OutputFile& output : image->keys.outputs) {
      listing.add(output.key);
      if (const PlacedFiles::Row* file = placed.find(output.path)) listing.add(file->object);
    }
  }
  add_older(listing, images, placed);
  sources.listing = listing.hash();
  return sources;
}

std::optional<ManifestSources> sources_as_planned(const Plan& plan) {
  if (!plan.manifest.listing) return std::nullopt;
  return ManifestSources{*plan.manifest.listing, plan.labels.hash, hash_of_program()};
}

Hash128 what_is_made(const Plan& plan) {
  HashStream hash;
  hash.add(plan.labels.hash);
  for (const PlannedImage& image : plan.images) {
    hash.add(image.keys.render);
    hash.add(image.keys.files);
  }
  return hash.hash();
}

bool manifest_stands(const Dataset& dataset, const ManifestSources& sources,
                     const PlacedFiles& placed) {
  return dataset.row.manifest == sources.listing &&
         written_from(placed, k_images_file, sources.listing) &&
         written_from(placed, k_dataset_file, sources.labels) &&
         written_from(placed, k_checksums_file, sources.program) &&
         std::all_of(k_manifest_files.begin(), k_manifest_files.end(), [&](const char* path) {
           return why_not_as_written(dataset, path, placed).empty();
         });
}

bool lines_hold(const Dataset& dataset, const ManifestSources& sources, const PlacedFiles& placed) {
  return written_from(placed, k_checksums_file, sources.program) &&
         why_not_as_written(dataset, k_images_file, placed).empty();
}

void remember_manifest(Dataset& dataset, const ManifestSources& sources) {
  Database& database = *dataset.database;
  Transaction transaction(database.connection());
  const auto remember = [&](const char* path, Hash128 source) {
    const fs::path file = dataset.folder / path;
    database.put_placed(dataset.row.id,
                        {path, "", k_manifest_kind, source, content_hash(file), stamp_of(file)});
  };
  remember(k_images_file, sources.listing);
  remember(k_dataset_file, sources.labels);
  remember(k_checksums_file, sources.program);
  dataset.row.manifest = sources.listing;
  database.set_manifest(dataset.row.id, sources.listing);
  transaction.commit();
}

ManifestState manifest_state(const Dataset& dataset, const Plan& plan, const PlacedFiles& placed) {
  ManifestState state;
  ListedImages images;
  bool any_stale = false, all_known = true;
  for (const PlannedImage& image : plan.images) {
    any_stale = any_stale || image.stale();
    all_known = all_known && !image.elsewhere && !image.error;
    if (!image.error && !image.elsewhere && !image.stale()) images.made.push_back(&image);
  }
  if (placed.find(k_images_file) == nullptr && images.made.empty()) return state;  // never built
  for (const char* path : k_manifest_files)
    if (const std::string why = why_not_as_written(dataset, path, placed); !why.empty())
      state.behind.push_back(why);
  if (!state.behind.empty()) return state;
  ManifestSources sources;
  try {
    sources = manifest_sources(plan, images, placed);
  } catch (const Error& error) {  // a licence that cannot be read: no reason to plan nothing
    state.behind.emplace_back(error.what());
    return state;
  }
  if (!any_stale && all_known) state.listing = sources.listing;
  if (placed.find(k_checksums_file)->product != sources.program)
    state.older_program = older_program(dataset.folder);
  if (placed.find(k_dataset_file)->product != sources.labels) {
    state.behind = differences(dataset, plan, any_stale);
    // What lines say of distractors is not seen at a glance.
    if (state.behind.empty() && !any_stale) state.behind.emplace_back("labels of objects");
  } else if (state.listing && placed.find(k_images_file)->product != sources.listing) {
    state.behind.push_back("the list of images");
  }
  return state;
}

}  // namespace ds

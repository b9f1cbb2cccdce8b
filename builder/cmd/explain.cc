// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/draws_text.h"
#include "builder/cmd/effects_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/plan/dataset_manifest.h"
#include "builder/plan/plan.h"
#include "manifests/manifest.h"
#include "tracer/base/canonical.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <filesystem>
#include <map>

namespace ds {
namespace {

namespace fs = std::filesystem;

using Changes = std::vector<std::pair<std::string, PropertyChange>>;

/// Lines shown of a long value that differs (the text of the traced program).
constexpr std::size_t k_most_lines = 40;

/// Changes of one part that are told one by one without -v: of a scene that was exchanged for
/// another there are a hundred, and none of them is what was done.
constexpr std::size_t k_most_told = 8;

/// One argument is the file of an image of a dataset; two are a dataset and an image.
DatasetRequest request_of(const Arguments& arguments, std::string& image) {
  DatasetRequest request = arguments.request();
  image = arguments.image;
  if (!image.empty()) return request;
  image = arguments.target;
  const std::optional<fs::path> folder = enclosing_dataset(arguments.target);
  if (!folder || fs::is_directory(arguments.target))
    fail(ErrorKind::usage,
         "explain: wanted a dataset and an image, or a file of a dataset; found {}",
         arguments.target);
  request.target = *folder;
  return request;
}

/// The id that a file's path, or a name without the folder of its model's, may have meant: "m110.off/0"
/// for "m110/0", "images/m110.off/0.png", "0".
std::string meant_id(const std::string& wanted, const std::vector<std::string_view>& ids) {
  const fs::path path(wanted);
  const std::string folder = path.parent_path().string(), file = path.filename().string();
  const std::string view = file.substr(0, file.find('.'));  // "0.mask.png"
  for (const std::string_view id : ids) {
    const fs::path known(id), model = known.parent_path();
    const auto ends_with = [&](const fs::path& name) {
      return folder == name || folder.ends_with("/" + name.string());
    };
    if (known.filename() == view &&
        (ends_with(model) || ends_with(model.parent_path() / model.stem())))
      return std::string(id);
  }
  return "";
}

const PlannedImage& find_image(const Plan& plan, const Dataset& dataset,
                               const std::string& wanted) {
  // An absolute path stays; a relative one may be so to the current folder or to the dataset's.
  std::error_code error;
  const fs::path file = fs::weakly_canonical(wanted, error);
  const fs::path folder = fs::weakly_canonical(dataset.folder, error);
  for (const PlannedImage& image : plan.images) {
    if (image.spec.id == wanted) return image;
    for (const OutputFile& output : image.keys.outputs)
      if (output.path == wanted || folder / output.path == file) return image;
  }
  const std::string inside = file.lexically_relative(folder).generic_string();
  if (inside.starts_with("images/") && fs::is_regular_file(file, error)) {
    const bool removed =
        std::find(plan.to_remove.begin(), plan.to_remove.end(), inside) != plan.to_remove.end();
    fail(ErrorKind::usage, "{}: no image of the recipe has this file{}", wanted,
         removed ? " any more; the next build removes it" : ", and dsbuild did not make it");
  }
  std::vector<std::string_view> ids;
  for (const PlannedImage& image : plan.images)
    ids.emplace_back(image.spec.id);
  const std::string meant = meant_id(wanted, ids);
  const std::string known =
      meant.empty() ? known_words(wanted, ids) : fmt::format(", did you mean {}?", meant);
  fail(
      ErrorKind::usage, "{}: the dataset has no such image{}", wanted,
      known.empty() ? fmt::format("; its first is {}", ids.empty() ? "none" : ids.front()) : known);
}

/// A material or environment that the image had when it was made, and the one that it has now.
struct Assigned {
  std::string name, before, after;
};

/// As the manifest tells it; nothing where that is not of the image as the database knows it.
std::vector<Assigned> assigned_since(const PlannedImage& image, const PartHashes& known,
                                     const fs::path& folder) {
  std::vector<Assigned> changes;
  try {
    for (const ImageRecord& record : read_images_manifest(folder)) {
      if (record.id != image.spec.id) continue;
      if (!std::equal(record.parts.begin(), record.parts.end(), known.begin())) return {};
      const auto compare = [&](const char* name, const std::string& before,
                               const std::string& after) {
        if (before != after) changes.push_back({name, before, after});
      };
      compare("material", record.material, *image.spec.material_name);
      compare("environment", record.environment, *image.spec.environment_name);
    }
  } catch (const Error&) {  // without a manifest nothing is known of names
  }
  return changes;
}

/// Whether a change follows from another material or environment: its properties, the program that
/// traces them, and the tone map that an environment brings.
bool follows(const std::pair<std::string, PropertyChange>& change,
             const std::vector<Assigned>& assigned) {
  return std::any_of(assigned.begin(), assigned.end(), [&](const Assigned& one) {
    return change.first == one.name ||
           (change.first == "engine" && change.second.name == "program") ||
           (one.name == "environment" &&
            (change.first == "files" || change.second.name.starts_with("schedule.")));
  });
}

nlohmann::json to_json(const std::string& part, const PropertyChange& change) {
  nlohmann::json object{{"part", part}, {"name", change.name}};
  object["before"] = change.before ? nlohmann::json(*change.before) : nlohmann::json();
  object["after"] = change.after ? nlohmann::json(*change.after) : nlohmann::json();
  return object;
}

/// The texts behind two references, where both are known.
void print_long_value(const PropertyChange& change, const TextLookup& find) {
  if (!change.before || !change.after) return;
  const std::string before = unfold(fmt::format("v = {}\n", *change.before), find);
  const std::string after = unfold(fmt::format("v = {}\n", *change.after), find);
  if (std::max(before.size(), after.size()) <= TextSet::k_longest_value) return;
  for (const std::string& line : diff_lines(before, after, k_most_lines))
    say(Stream::result, "    {}\n", line);
}

void print_changes(const Changes& changes, const TextLookup& find) {
  for (const auto& [part, change] : changes) {
    say(Stream::result, "  {}: {}\n", part, to_string(change));
    print_long_value(change, find);
  }
}

/// The scene file that a part's properties come from; empty for what comes from the recipe.
std::string scene_of(const std::string& part, const ImageSpec& spec) {
  if (part == "material") return spec.material_file->string();
  if (part == "environment") return (*spec.environment_folder / "environment.scn").string();
  return "";
}

/// Takes out the changes of parts that have too many to be told, and tells how many there were; and
/// the program's where it is another because the scene is.
void print_many(Changes& changes, const ImageSpec& spec) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [part, change] : changes)
    ++counts[part];
  if (counts.contains("material") || counts.contains("environment"))
    std::erase_if(changes, [](const auto& change) {
      return change.first == "engine" && change.second.name == "program";
    });
  for (const auto& [part, count] : counts) {
    if (count <= k_most_told) continue;
    const std::string scene = scene_of(part, spec);
    say(Stream::result, "  {}: {}{} properties changed (-v tells each)\n", part,
        scene.empty() ? "" : scene + ": ", count);
  }
  std::erase_if(changes, [&](const auto& change) { return counts[change.first] > k_most_told; });
}

/// ": forced; ...": the reasons that are not among the changes, which are told line by line.
std::string other_reasons(const PlannedImage& image, const Changes& changes) {
  std::string text;
  for (const std::string& reason : image.reasons) {
    const bool told = std::any_of(changes.begin(), changes.end(), [&](const auto& change) {
      return reason.starts_with(change.first + " changed: ");
    });
    const bool counted = !changes.empty() && reason.starts_with("and ");
    if (!told && !counted) text += (text.empty() ? ": " : "; ") + reason;
  }
  return text;
}

}  // namespace

int run_explain(const Arguments& arguments) {
  std::string wanted;
  const DatasetRequest request = request_of(arguments, wanted);
  RealDisk disk;
  Dataset dataset = open_dataset(request, Access::look, disk);
  Inputs inputs(*dataset.database);
  const Plan plan = make_plan(dataset, inputs, false);
  const PlannedImage& image = find_image(plan, dataset, wanted);
  if (image.error) throw *image.error;

  Changes changes;
  std::vector<Assigned> assigned;
  const auto images = dataset.database->images(dataset.row.id);
  const auto before = images.find(image.spec.id);
  if (before != images.end()) {
    changes = changes_since(image, before->second, plan.texts, *dataset.database);
    if (!changes.empty()) assigned = assigned_since(image, before->second, dataset.folder);
  }
  const TextLookup find = [&](Hash128 hash) -> std::optional<std::string> {
    if (const std::string* text = plan.texts.find(hash)) return *text;
    return dataset.database->find_text(hash);
  };
  if (arguments.json) {
    nlohmann::json object{{"id", image.spec.id},
                          {"step", step_of(image)},
                          {"reasons", image.reasons},
                          {"render_key", image.keys.render.hex()},
                          {"assigned", nlohmann::json::array()},
                          {"changes", nlohmann::json::array()}};
    for (const Assigned& one : assigned)
      object["assigned"].push_back(
          {{"name", one.name}, {"before", one.before}, {"after", one.after}});
    for (std::size_t i = 0; i < k_part_count; ++i)
      object["parts"][k_part_names[i]] = image.keys.parts[i].hex();
    for (const auto& [part, change] : changes)
      object["changes"].push_back(to_json(part, change));
    if (!dataset.recipe.drawn.empty() || !dataset.recipe.distractors.drawn.empty())
      object["draws"] = to_json_value(draws_of(image.spec, dataset.recipe));
    if (arguments.effects)
      object["effects"] = to_json(image_effects(dataset.recipe, inputs, image.spec));
    print_json(object);
    return 0;
  }
  if (image.stale())
    say(Stream::result, "{}: {}{}\n", image.spec.id, step_of(image), other_reasons(image, changes));
  else
    say(Stream::result, "{}: up to date\n", image.spec.id);
  for (const Assigned& one : assigned)
    say(Stream::result, "  {}: {} -> {}\n", one.name, one.before, one.after);
  std::erase_if(changes, [&](const auto& change) { return follows(change, assigned); });
  if (!arguments.verbose) print_many(changes, image.spec);
  print_changes(changes, find);
  print_draws(dataset.recipe, image.spec);
  say(Stream::result, "render key {}\n", image.keys.render.hex());
  for (std::size_t i = 0; i < k_part_count; ++i)
    say(Stream::result, "  {:<11} {}\n", k_part_names[i], image.keys.parts[i].hex());
  if (arguments.effects) print_effects(image_effects(dataset.recipe, inputs, image.spec));
  return 0;
}

}  // namespace ds

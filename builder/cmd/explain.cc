// SPDX-License-Identifier: Apache-2.0
#include "builder/build/plan.h"
#include "builder/cmd/effects_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/canonical.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <filesystem>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Lines shown of a long value that differs (the text of the traced program).
constexpr std::size_t k_most_lines = 40;

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
  std::vector<std::string_view> ids;
  for (const PlannedImage& image : plan.images)
    ids.emplace_back(image.spec.id);
  const std::string known = known_words(wanted, ids);
  fail(
      ErrorKind::usage, "{}: the dataset has no such image{}", wanted,
      known.empty() ? fmt::format("; its first is {}", ids.empty() ? "none" : ids.front()) : known);
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

void print_changes(const std::vector<std::pair<std::string, PropertyChange>>& changes,
                   const TextLookup& find) {
  for (const auto& [part, change] : changes) {
    say(Stream::result, "  {}: {}\n", part, to_string(change));
    print_long_value(change, find);
  }
}

/// ": forced; ...": the reasons that are not among the changes, which are told line by line.
std::string other_reasons(const PlannedImage& image,
                          const std::vector<std::pair<std::string, PropertyChange>>& changes) {
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

  std::vector<std::pair<std::string, PropertyChange>> changes;
  const auto images = dataset.database->images(dataset.row.id);
  const auto before = images.find(image.spec.id);
  if (before != images.end())
    changes = changes_since(image, before->second, plan.texts, *dataset.database);
  const TextLookup find = [&](Hash128 hash) -> std::optional<std::string> {
    if (const std::string* text = plan.texts.find(hash)) return *text;
    return dataset.database->find_text(hash);
  };
  if (arguments.json) {
    nlohmann::json object{{"id", image.spec.id},
                          {"step", step_of(image)},
                          {"reasons", image.reasons},
                          {"render_key", image.keys.render.hex()},
                          {"changes", nlohmann::json::array()}};
    for (std::size_t i = 0; i < k_part_count; ++i)
      object["parts"][k_part_names[i]] = image.keys.parts[i].hex();
    for (const auto& [part, change] : changes)
      object["changes"].push_back(to_json(part, change));
    if (arguments.effects)
      object["effects"] = to_json(image_effects(dataset.recipe, inputs, image.spec));
    print_json(object);
    return 0;
  }
  if (image.stale())
    say(Stream::result, "{}: {}{}\n", image.spec.id, step_of(image), other_reasons(image, changes));
  else
    say(Stream::result, "{}: up to date\n", image.spec.id);
  print_changes(changes, find);
  say(Stream::result, "render key {}\n", image.keys.render.hex());
  for (std::size_t i = 0; i < k_part_count; ++i)
    say(Stream::result, "  {:<11} {}\n", k_part_names[i], image.keys.parts[i].hex());
  if (arguments.effects) print_effects(image_effects(dataset.recipe, inputs, image.spec));
  return 0;
}

}  // namespace ds

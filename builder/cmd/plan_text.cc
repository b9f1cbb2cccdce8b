// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"

#include "builder/cmd/groups.h"
#include "tracer/base/error.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ds {

Stamps stamps_of(const Arguments& arguments) {
  return arguments.rehash ? Stamps::ignore : Stamps::trust;
}

Shard shard_of(const Arguments& arguments) {
  return arguments.shard.empty() ? Shard{} : read_shard(arguments.shard);
}

const char* step_of(const PlannedImage& image) {
  if (!image.stale()) return "";
  if (image.traces_paths() || image.trace_planes) return "trace";
  const auto to_make = [](const PlannedFile& file) { return file.state == FileState::to_make; };
  return std::any_of(image.files.begin(), image.files.end(), to_make) ? "develop" : "place";
}

PlanCounts count(const Plan& plan) {
  PlanCounts counts;
  counts.remove = plan.to_remove.size();
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere) continue;
    ++counts.images;
    const std::string_view step = step_of(image);
    counts.failed += image.error ? 1U : 0U;
    counts.up_to_date += !image.error && step.empty() ? 1U : 0U;
    counts.stale += step.empty() ? 0U : 1U;
    counts.trace += step == "trace" ? 1U : 0U;
    counts.develop += step == "develop" ? 1U : 0U;
    counts.place += step == "place" ? 1U : 0U;
    counts.samples += image.traces_paths() ? image.samples() : 0;
  }
  return counts;
}

std::string manifest_line(const ManifestState& manifest) {
  std::vector<std::string> behind = manifest.behind;
  if (!manifest.older_program.empty())
    behind.push_back("written by dsbuild " + manifest.older_program);
  if (behind.empty()) return "";
  return fmt::format("manifest behind: {}; dsbuild build writes it anew", fmt::join(behind, "; "));
}

void print_manifest_line(const Plan& plan) {
  if (const std::string line = manifest_line(plan.manifest); !line.empty())
    say(Stream::result, "{}\n", line);
}

std::string edited_text(const Plan& plan) {
  constexpr std::size_t k_most_named = 3;
  const std::size_t count = plan.edited.size();
  if (count == 0) return "";
  const auto end = plan.edited.begin() + static_cast<std::ptrdiff_t>(std::min(count, k_most_named));
  return fmt::format("{} not as a build wrote {}, and {} replaced or removed: {}{}",
                     count == 1 ? "1 file is" : fmt::format("{} files are", count),
                     count == 1 ? "it" : "them", count == 1 ? "is" : "are",
                     fmt::join(plan.edited.begin(), end, ", "),
                     count > k_most_named ? fmt::format(" and {} more", count - k_most_named) : "");
}

void print_edited(const Plan& plan) {
  if (const std::string line = edited_text(plan); !line.empty()) say(Stream::result, "{}\n", line);
}

nlohmann::json to_json(const ManifestState& manifest) {
  return {{"behind", manifest.behind}, {"older_program", manifest.older_program}};
}

std::string summary(const PlanCounts& counts) {
  std::string text = fmt::format(
      "{} images: {} to make ({} to trace, {} to develop, {} to take from the store), {} up to "
      "date",
      counts.images, counts.stale, counts.trace, counts.develop, counts.place, counts.up_to_date);
  if (counts.failed > 0) text += fmt::format(", {} cannot be made", counts.failed);
  if (counts.remove > 0) text += fmt::format("; {} files to remove", counts.remove);
  return text;
}

nlohmann::json to_json(const PlanCounts& counts) {
  return {
      {"images", counts.images}, {"up_to_date", counts.up_to_date}, {"stale", counts.stale},
      {"trace", counts.trace},   {"develop", counts.develop},       {"place", counts.place},
      {"failed", counts.failed}, {"remove", counts.remove},         {"samples", counts.samples}};
}

std::string line_of(const PlannedImage& image) {
  return fmt::format("{}: {}: {}", image.spec.id, step_of(image), fmt::join(image.reasons, "; "));
}

namespace {

/// The reasons with the image's own name taken out of the paths in them, so that images that are
/// stale for one reason are found to be so.
std::string common_reason(const PlannedImage& image) {
  return with_replaced(fmt::format("{}: {}", step_of(image), fmt::join(image.reasons, "; ")),
                       "images/" + image.spec.id, "images/*");
}

/// "view changed: position" of "view changed: position: 0 1 2 -> 0 1 3".
std::string without_values(const std::string& reason) {
  const std::size_t property = reason.find(" changed: ");
  return property == reason.npos ? reason : reason.substr(0, reason.find(": ", property + 10));
}

/// The same without values: "trace: view changed: position".
std::string common_properties(const PlannedImage& image) {
  std::vector<std::string> reasons;
  for (const std::string& reason : image.reasons)
    reasons.push_back(without_values(reason));
  return with_replaced(fmt::format("{}: {}", step_of(image), fmt::join(reasons, "; ")),
                       "images/" + image.spec.id, "images/*");
}

Groups stale_groups(const Plan& plan, std::string (*cause)(const PlannedImage&)) {
  Groups groups;
  for (const PlannedImage& image : plan.images)
    if (!image.elsewhere && image.stale()) groups.add(cause(image), image.spec.id, line_of(image));
  return groups;
}

/// By reason. A camera that fits its model gives every image other values: where there are so many
/// reasons, only what changed tells them apart.
Groups stale_groups(const Plan& plan) {
  constexpr std::size_t k_most_reasons = 8;
  Groups by_value = stale_groups(plan, common_reason);
  return by_value.size() > k_most_reasons ? stale_groups(plan, common_properties)
                                          : std::move(by_value);
}

}  // namespace

void print_plan(Stream to, const Plan& plan, bool all_names) {
  const Groups stale = stale_groups(plan);
  Groups removed, failed;
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere) continue;
    const std::string& id = image.spec.id;
    if (!image.error) continue;
    const std::string why = fmt::format("cannot be made: {}", image.error->what());
    failed.add(why, id, fmt::format("{}: {}", id, why));
  }
  std::set<std::string> refused;
  for (const PlannedImage& image : plan.images)
    if (image.refused)
      for (const OutputFile& output : image.keys.outputs)
        refused.insert(output.path);
  for (const std::string& path : plan.to_remove) {
    const std::string what = refused.contains(path) ? "remove: its picture is refused"
                                                    : "remove: no image of the recipe has it";
    removed.add(what, path, fmt::format("{}: {}", path, what));
  }
  for (const Groups* groups : {&stale, &std::as_const(removed), &std::as_const(failed)})
    groups->print(to, all_names);
}

void print_json(const nlohmann::json& object) {
  say(Stream::result, "{}\n",
      object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace ds

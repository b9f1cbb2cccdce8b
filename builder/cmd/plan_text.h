// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"
#include "builder/plan/plan.h"
#include "tracer/base/streams.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace ds {

/// What --rehash says.
Stamps stamps_of(const Arguments& arguments);
/// What --shard says.
Shard shard_of(const Arguments& arguments);

/// A plan in numbers, of the shard's images.
struct PlanCounts {
  std::uint64_t images = 0, up_to_date = 0, failed = 0;
  std::uint64_t stale = 0;    ///< = trace + develop + place
  std::uint64_t trace = 0;    ///< a film or geometry is to be traced
  std::uint64_t develop = 0;  ///< the film is there
  std::uint64_t place = 0;    ///< the files are in the store
  std::uint64_t remove = 0;   ///< files, not images
  std::uint64_t samples = 0;  ///< camera samples to trace
};
PlanCounts count(const Plan& plan);

/// "manifest behind: class_path of 4 images (a.off/0: car -> van); dsbuild build writes it anew";
/// empty where it is not.
std::string manifest_line(const ManifestState& manifest);
/// Prints that line where there is one.
void print_manifest_line(const Plan& plan);
/// How many files a build replaces or removes that hold what no build wrote, with a few of their
/// names; empty where there is none.
std::string edited_text(const Plan& plan);
/// Prints that line where there is one.
void print_edited(const Plan& plan);
/// {"behind": [...], "older_program": "0.1.0"}.
nlohmann::json to_json(const ManifestState& manifest);

/// "168 images: 3 to make (2 to trace, 1 to develop, 0 to take from the store), 165 up to date, 0
/// failed".
std::string summary(const PlanCounts& counts);
nlohmann::json to_json(const PlanCounts& counts);

/// One line: "human.ply/0: trace: material changed: body.kd: 0.5 -> 0.25; ...".
std::string line_of(const PlannedImage& image);
/// What it needs: "trace", "develop", "place"; empty for an image that is up to date.
const char* step_of(const PlannedImage& image);

/// Lists what of the shard is stale or fails on the stream, and what is to be removed: images with
/// one reason in one line, and under it, with `all_names`, the name of each.
void print_plan(Stream to, const Plan& plan, bool all_names = false);

/// Prints one JSON object as the last line of standard output. Text that is no UTF-8 is mended with
/// U+FFFD.
void print_json(const nlohmann::json& object);

}  // namespace ds

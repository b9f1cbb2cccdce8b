// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/from_manifest.h"

#include "builder/cmd/plan_text.h"
#include "builder/plan/plan.h"
#include "tracer/base/error.h"
#include "tracer/base/regular_file.h"

#include <algorithm>
#include <filesystem>

namespace ds {

namespace {

/// Lines of images.jsonl; none where it cannot be read.
std::uint64_t listed_images(const std::filesystem::path& folder) {
  std::ifstream file = regular_stream(folder / "manifest/images.jsonl");
  std::uint64_t lines = 0;
  for (std::string line; std::getline(file, line);)
    lines += line.empty() ? 0U : 1U;
  return lines;
}

}  // namespace

BehindRecipe behind_recipe(const Arguments& arguments, const std::string& written) {
  try {
    RealDisk disk;
    Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
    Inputs inputs(*dataset.database, Stamps::trust);
    const Plan plan = make_plan(dataset, inputs, false);
    const PlanCounts counts = count(plan);
    const std::uint64_t listed = listed_images(dataset.folder);
    BehindRecipe behind;
    behind.images = counts.images;
    // Where nothing is listed there is no dataset, which its reader says.
    if (listed > 0) behind.unmade = counts.images - std::min(counts.images, listed);
    behind.text =
        counts.stale > 0 || counts.failed > 0
            ? fmt::format(
                  "{} of {} images are not as their recipe wants them; {} (dsbuild build first?)",
                  counts.stale + counts.failed, counts.images, written)
            : manifest_line(plan.manifest);
    return behind;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace ds

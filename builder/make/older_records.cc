// SPDX-License-Identifier: Apache-2.0
#include "builder/make/older_records.h"

#include "builder/plan/keys.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/log.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {
namespace {

std::vector<ImageRecord> read_older(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder / "manifest/images.jsonl", error)) return {};
  try {
    return read_images_manifest(folder);
  } catch (const Error& damaged) {
    warn(fmt::format("{}; images that are not made anew are left out of the new one",
                     damaged.what()));
    return {};
  }
}

/// A file that cannot be looked at is not known to be what a line says.
bool in_place(PlacedFiles& placed, const ImageRecord& record) {
  try {
    return placed.in_place(record);
  } catch (const DiskFailed&) {
    throw;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void add_older_records(std::vector<ImageRecord>& records, const Dataset& dataset,
                       const std::vector<const PlannedImage*>& lacking, bool all,
                       PlacedFiles& placed) {
  if (lacking.empty() && !all) return;
  std::map<std::string, const PlannedImage*> lacking_ids;
  for (const PlannedImage* image : lacking)
    lacking_ids.emplace(image->spec.id, image);
  std::set<std::string> listed;
  for (const ImageRecord& record : records)
    listed.insert(record.id);
  for (ImageRecord& record : read_older(dataset.folder)) {
    const auto image = lacking_ids.find(record.id);
    const bool of_plan = image != lacking_ids.end();
    if (listed.contains(record.id) || !(of_plan || all)) continue;
    if (of_plan) {
      if (image->second->refused) continue;
      record.class_path = image->second->spec.class_path;
      record.split = image->second->spec.split;
    }
    if (of_plan && !all) {
      // Of an output that is switched off the file is gone.
      const auto wanted = output_paths(dataset.recipe.outputs, record.id);
      std::erase_if(record.files, [&](const FileRecord& file) {
        return std::find(wanted.begin(), wanted.end(), file.path) == wanted.end();
      });
    }
    if (!record.files.empty() && in_place(placed, record)) records.push_back(std::move(record));
  }
}

}  // namespace ds

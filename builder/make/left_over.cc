// SPDX-License-Identifier: Apache-2.0
#include "builder/make/left_over.h"

#include "tracer/base/disk_error.h"

#include <filesystem>
#include <set>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Those that went.
std::vector<std::string> remove_files(const fs::path& dataset, const Plan& plan, Disk& disk,
                                      RemovedFiles& result) {
  std::set<fs::path> folders;
  std::vector<std::string> removed;
  for (const std::string& path : plan.to_remove) {
    try {
      disk.remove(dataset / path);
      removed.push_back(path);
    } catch (const DiskFailed&) {
      throw;
    } catch (const Error& error) {  // no reason to end this build
      result.failures.emplace_back(path, error.what());
    }
    folders.insert((dataset / path).parent_path());
  }
  std::error_code not_empty;
  // A model's name may be a path: its folder may have left one above empty.
  for (fs::path folder : folders)
    while (folder.parent_path() != dataset && fs::remove(folder, not_empty))
      folder = folder.parent_path();
  return removed;
}

}  // namespace

RemovedFiles remove_left_over(Dataset& dataset, const Plan& plan, Disk& disk) {
  RemovedFiles result;
  if (plan.to_remove.empty() && !plan.forgets) return result;
  const std::vector<std::string> removed = remove_files(dataset.folder, plan, disk, result);
  result.files = removed.size();
  std::set<std::string> wanted;
  for (const PlannedImage& image : plan.images)
    wanted.insert(image.spec.id);
  Database& database = *dataset.database;
  Transaction transaction(database.connection());
  for (const std::string& path : removed)
    database.remove_placed(dataset.row.id, path);
  for (const auto& [id, parts] : database.images(dataset.row.id))
    if (!wanted.contains(id)) database.remove_image(dataset.row.id, id);
  transaction.commit();
  return result;
}

}  // namespace ds

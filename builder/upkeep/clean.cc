// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/clean.h"

#include "builder/plan/placed_files.h"
#include "builder/store/folder_lock.h"
#include "tracer/base/error.h"

#include <string>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

void remove_empty_folders(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> folders{folder};
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    std::error_code ignored;
    if (at->is_directory(ignored) && !at->is_symlink(ignored)) folders.push_back(at->path());
  }
  // What stands in another comes later.
  for (std::size_t i = folders.size(); i-- > 0;)
    fs::remove(folders[i], error);
}

}  // namespace

CleanResult clean_dataset(Dataset& dataset, Disk& disk, bool dry_run) {
  FolderLock lock(dataset.lock_folder);
  if (const auto who = lock.try_join(hash_text("clean"), "dsbuild clean"))
    fail(ErrorKind::usage, "{}: {} builds it now; clean it when that is done",
         dataset.folder.string(), *who);
  CleanResult result;
  std::vector<std::string> removed;
  const PlacedFiles there(dataset);
  for (const auto& [path, placed] : dataset.database->placed_files(dataset.row.id)) {
    const fs::path file = dataset.folder / path;
    std::error_code error;
    if (fs::symlink_status(file, error).type() == fs::file_type::not_found) {
      removed.push_back(path);
      continue;
    }
    if (there.find_there(path) != PlacedFiles::Found::ours) {
      result.edited.push_back(file);
      continue;
    }
    ++result.files;
    result.bytes += fs::file_size(file, error);
    removed.push_back(path);
  }
  if (dry_run) return result;
  for (const std::string& path : removed)
    disk.remove(dataset.folder / path);
  for (const char* folder : {"images", "manifest"})
    remove_empty_folders(dataset.folder / folder);
  Database& database = *dataset.database;
  Transaction transaction(database.connection());
  for (const std::string& path : removed)
    database.remove_placed(dataset.row.id, path);
  for (const auto& [id, parts] : database.images(dataset.row.id))
    database.remove_image(dataset.row.id, id);
  database.set_manifest(dataset.row.id, {});
  transaction.commit();
  return result;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/restore.h"

#include "builder/db/named_products.h"
#include "builder/plan/plan.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

struct Missing {
  Hash128 object;
  fs::path file;  ///< where a build placed it
};

std::vector<Missing> missing_objects(const Store& store, Database& database) {
  std::map<std::string, fs::path, std::less<>> folders;
  for (const DatasetRow& row : all_datasets(database))
    folders.emplace(row.id, folder_of_dataset(store, row.id));
  std::vector<Missing> missing;
  visit_all_placed(database, [&](const std::string& dataset, const PlacedView& file) {
    const auto folder = folders.find(dataset);
    if (folder == folders.end() || folder->second.empty()) return;
    if (file.kind == k_manifest_kind || store.has(file.object)) return;
    missing.push_back({file.object, folder->second / file.path});
  });
  return missing;
}

/// Nothing where the file is not there, or holds other bytes.
bool put_back(Store& store, const Missing& missing) {
  std::error_code error;
  if (!fs::is_regular_file(missing.file, error)) return false;
  std::string bytes;
  try {
    bytes = read_text_file(missing.file);
  } catch (const Error&) {  // as good as not there
    return false;
  }
  if (hash_text(bytes) != missing.object) return false;
  store.put(bytes_of(bytes));
  return true;
}

}  // namespace

std::uint64_t restore_objects(Store& store, Database& database, const std::atomic<bool>& stop) {
  std::uint64_t restored = 0;
  for (const Missing& missing : missing_objects(store, database)) {
    if (stop) fail(ErrorKind::cancelled, "stopped");
    // Several files may be one object's.
    if (!store.has(missing.object) && put_back(store, missing)) ++restored;
  }
  return restored;
}

}  // namespace ds

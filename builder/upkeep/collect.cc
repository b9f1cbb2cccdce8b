// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/collect.h"

#include "builder/db/named_products.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <tuple>
#include <vector>

namespace ds {
namespace {

/// Which files go: unnamed ones that are old enough, oldest first.
std::vector<const StoreFileUse*> chosen(const CollectRequest& request, const StoreUse& use) {
  const auto now = std::filesystem::file_time_type::clock::now();
  std::vector<const StoreFileUse*> files;
  std::uint64_t bytes = 0;
  for (const StoreFileUse& file : use.files) {
    bytes += file.bytes;
    if (!file.is_named && now - file.written >= request.older) files.push_back(&file);
  }
  std::sort(files.begin(), files.end(), [](const StoreFileUse* a, const StoreFileUse* b) {
    return std::tie(a->written, a->hash) < std::tie(b->written, b->hash);
  });
  if (!request.most_bytes) return files;
  auto end = files.begin();
  for (; end != files.end() && bytes > *request.most_bytes; ++end)
    bytes -= (*end)->bytes;
  files.erase(end, files.end());
  return files;
}

}  // namespace

CollectResult collect(Store& store, Database& database, const CollectRequest& request,
                      const StoreUse& use) {
  const std::vector<const StoreFileUse*> files = chosen(request, use);
  CollectResult result;
  for (const StoreFileUse* file : files)
    (file->kind == Store::Kind::object ? result.objects : result.records).add(file->bytes);
  result.temporaries = {use.temporaries.size(), use.temporary_bytes};
  const std::set<const StoreFileUse*> goes(files.begin(), files.end());
  for (const StoreFileUse& file : use.files) {
    if (goes.contains(&file)) continue;
    result.kept.add(file.bytes);
    if (!file.is_named) result.unnamed.add(file.bytes);
  }
  std::vector<std::string> forgotten;
  for (const DatasetUse& dataset : use.datasets)
    if (request.forget_gone && dataset.is_gone) forgotten.push_back(dataset.row.id);
  result.forgotten = forgotten.size();
  // Rows of objects that stay may stay: a build that comes back to them traces nothing.
  std::set<Hash128> gone;
  for (const StoreFileUse* file : files)
    if (file->kind == Store::Kind::object) gone.insert(file->hash);
  std::vector<Hash128> rows;
  const std::set<Hash128> unnamed(use.unnamed_products.begin(), use.unnamed_products.end());
  visit_products(database, [&](Hash128 key, std::string_view, Hash128 object) {
    if (unnamed.contains(key) && gone.contains(object)) rows.push_back(key);
  });
  result.products = rows.size();
  if (request.dry_run) return result;

  for (const StoreFileUse* file : files)
    if (file->kind == Store::Kind::record) store.remove(file->kind, file->hash);
  {
    Transaction transaction(database.connection());
    for (const Hash128 key : rows)
      remove_product(database, key);
    for (const std::string& id : forgotten)
      remove_dataset(database, id);
    transaction.commit();
  }
  for (const StoreFileUse* file : files)
    if (file->kind == Store::Kind::object) store.remove(file->kind, file->hash);
  std::error_code ignored;
  for (const std::filesystem::path& file : use.temporaries)
    std::filesystem::remove(file, ignored);
  return result;
}

}  // namespace ds

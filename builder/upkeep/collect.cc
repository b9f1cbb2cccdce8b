// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/collect.h"

#include "builder/db/named_products.h"
#include "builder/db/unused_texts.h"
#include "builder/store/made_record.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace ds {
namespace {

using FileUses = std::vector<const StoreFileUse*>;

/// Which files go: unnamed ones that are old enough, oldest first.
FileUses chosen(const CollectRequest& request, const StoreUse& use) {
  const auto now = std::filesystem::file_time_type::clock::now();
  FileUses files;
  std::uint64_t bytes = use.database_bytes - use.database_free;
  for (const StoreFileUse& file : use.files) {
    bytes += file.bytes;
    if (!file.is_named && !file.is_being_made && now - file.written >= request.older)
      files.push_back(&file);
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

/// Rows of the database that go.
struct Rows {
  std::vector<std::string> datasets;
  std::vector<Hash128> products, texts;
};

/// Rows of objects that stay may stay: a build that comes back to them traces nothing.
Rows rows_to_remove(Database& database, const CollectRequest& request, const StoreUse& use,
                    const std::set<Hash128>& objects_left) {
  Rows rows;
  for (const DatasetUse& dataset : use.datasets)
    if (request.forget_gone && dataset.is_gone) rows.datasets.push_back(dataset.row.id);
  const std::set<Hash128> unnamed(use.unnamed_products.begin(), use.unnamed_products.end());
  visit_products(database, [&](Hash128 key, std::string_view, Hash128 object) {
    if (unnamed.contains(key) && !objects_left.contains(object)) rows.products.push_back(key);
  });
  rows.texts = unused_texts(database, {rows.datasets.begin(), rows.datasets.end()});
  return rows;
}

void remove_rows(Database& database, const Rows& rows) {
  Transaction transaction(database.connection());
  for (const Hash128 key : rows.products)
    remove_product(database, key);
  for (const Hash128 text : rows.texts)
    remove_text(database, text);
  for (const std::string& id : rows.datasets)
    remove_dataset(database, id);
  transaction.commit();
}

/// A record of which lines go.
struct Shortened {
  Hash128 record;
  std::string text;  ///< without them
};

std::vector<Shortened> shortened_records(const Store& store, const StoreUse& use,
                                         const std::set<Hash128>& objects_left,
                                         CollectResult& result) {
  std::vector<Shortened> all;
  for (const PartlyNamed& one : use.partly_named) {
    std::string text;
    if (store.examine(Store::Kind::record, one.record, &text) != Store::Health::whole) continue;
    Shortened shortened{one.record, {}};
    for (const RecordLine& line : record_lines(text)) {
      const bool is_unnamed =
          std::find(one.unnamed.begin(), one.unnamed.end(), line.key) != one.unnamed.end();
      if (is_unnamed && !objects_left.contains(line.object))
        ++result.lines;
      else
        shortened.text += line.text;
    }
    if (shortened.text.size() == text.size()) continue;
    result.kept.bytes -= text.size() - shortened.text.size();
    all.push_back(std::move(shortened));
  }
  return all;
}

/// The new ones first, some at a time: they wait for the disk together.
void shorten(Store& store, const std::vector<Shortened>& records) {
  constexpr std::size_t k_together = 64;
  for (std::size_t done = 0; done < records.size(); done += k_together) {
    const std::size_t end = std::min(done + k_together, records.size());
    std::vector<std::string> texts;
    for (std::size_t i = done; i < end; ++i)
      texts.push_back(records[i].text);
    store.put_all({}, texts);
    for (std::size_t i = done; i < end; ++i)
      store.remove(Store::Kind::record, records[i].record);
  }
}

/// Where a sixteenth or more of it holds nothing, or a size is wanted. A disk that has no room for that
/// leaves it as it is.
void shrink_database(Database& database, const CollectRequest& request, CollectResult& result) {
  const DatabaseSize size = size_of(database);
  const std::uint64_t least = request.most_bytes ? 1 : size.bytes / 16;
  try {
    if (size.free_bytes > 0 && size.free_bytes >= least) shrink(database);
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const Error& error) {
    result.not_shrunk = error.what();
  }
  result.database_left = size_of(database).bytes;
}

}  // namespace

CollectResult collect(Store& store, Database& database, const CollectRequest& request,
                      const StoreUse& use) {
  const FileUses files = chosen(request, use);
  CollectResult result;
  for (const StoreFileUse* file : files)
    (file->kind == Store::Kind::object ? result.objects : result.records).add(file->bytes);
  result.temporaries = {use.temporaries.size(), use.temporary_bytes};
  result.database_bytes = use.database_bytes - use.database_free;
  const std::set<const StoreFileUse*> goes(files.begin(), files.end());
  std::set<Hash128> objects_left;
  for (const StoreFileUse& file : use.files) {
    if (goes.contains(&file)) continue;
    if (file.kind == Store::Kind::object) objects_left.insert(file.hash);
    result.kept.add(file.bytes);
    if (!file.is_named) (file.is_being_made ? result.being_made : result.unnamed).add(file.bytes);
  }
  const Rows rows = rows_to_remove(database, request, use, objects_left);
  result.forgotten = rows.datasets.size();
  result.products = rows.products.size();
  result.texts = rows.texts.size();
  const std::vector<Shortened> shortened = shortened_records(store, use, objects_left, result);
  if (request.dry_run) return result;

  for (const StoreFileUse* file : files)
    if (file->kind == Store::Kind::record) store.remove(file->kind, file->hash);
  remove_rows(database, rows);
  for (const StoreFileUse* file : files)
    if (file->kind == Store::Kind::object) store.remove(file->kind, file->hash);
  shorten(store, shortened);
  std::error_code ignored;
  for (const std::filesystem::path& file : use.temporaries)
    std::filesystem::remove(file, ignored);
  shrink_database(database, request, result);
  return result;
}

}  // namespace ds

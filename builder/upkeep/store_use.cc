// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/store_use.h"

#include "builder/db/named_products.h"
#include "builder/make/image_keeper.h"
#include "builder/plan/keys.h"
#include "builder/store/made_record.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace ds {
namespace {

struct HashOfHash {
  std::size_t operator()(Hash128 hash) const { return static_cast<std::size_t>(hash.low); }
};
using HashSet = std::unordered_set<Hash128, HashOfHash>;

/// What the datasets that count name.
struct Named {
  HashSet products;  ///< keys: of placed files, and of images' films
  HashSet objects;
};

std::vector<DatasetUse> datasets_of(const Store& store, Database& database) {
  std::vector<DatasetUse> uses;
  for (DatasetRow& row : all_datasets(database)) {
    DatasetUse use{std::move(row), {}, false, 0};
    use.folder = folder_of_dataset(store, use.row.id);
    use.is_gone = !use.folder.empty() && !holds_dataset(use.folder, use.row.id);
    uses.push_back(std::move(use));
  }
  std::stable_sort(uses.begin(), uses.end(), [](const DatasetUse& a, const DatasetUse& b) {
    return std::tie(a.row.name, a.folder) < std::tie(b.row.name, b.folder);
  });
  return uses;
}

std::vector<std::filesystem::path> unknown_datasets(const Store& store,
                                                    const std::vector<DatasetUse>& known) {
  std::vector<std::filesystem::path> folders;
  for (const auto& [id, folder] : datasets_beside(store))
    if (std::none_of(
            known.begin(), known.end(),
            [&, id = std::string_view(id)](const DatasetUse& use) { return use.row.id == id; }))
      folders.push_back(folder);
  return folders;
}

Named named_by(Database& database, std::vector<DatasetUse>& datasets, bool forget_gone) {
  std::map<std::string, DatasetUse*, std::less<>> counting;
  for (DatasetUse& use : datasets)
    if (!forget_gone || !use.is_gone) counting.emplace(use.row.id, &use);
  Named named;
  visit_all_images(database, [&](const std::string& dataset, const PartHashes& parts) {
    const auto at = counting.find(dataset);
    if (at == counting.end()) return;
    ++at->second->images;
    named.products.insert(render_key(parts));
  });
  visit_all_placed(database, [&](const std::string& dataset, const PlacedView& file) {
    if (!counting.contains(dataset)) return;
    if (file.kind == k_manifest_kind) return;  // written, and in no store
    named.products.insert(file.product);
    named.objects.insert(file.object);
  });
  return named;
}

/// False for a temporary that a killed writer left, which is noted.
bool is_ours(const Store::StoredFile& file, StoreUse& use, const std::atomic<bool>& stop) {
  if (stop) fail(ErrorKind::cancelled, "stopped; nothing is removed");
  if (file.hash) return true;
  use.temporaries.push_back(file.path);
  use.temporary_bytes += file.bytes;
  return false;
}

/// Reads all records. The sums of a film, by which it can be gone on with, are named where its film or
/// picture is.
void look_at_records(Store& store, const Named& named, HashSet& objects, HashSet& products,
                     StoreUse& use, const std::atomic<bool>& stop) {
  store.visit_files(Store::Kind::record, [&](const Store::StoredFile& file) {
    if (!is_ours(file, use, stop)) return;
    StoreFileUse found{Store::Kind::record, *file.hash, file.bytes, file.written, false};
    if (const std::optional<std::string> text = store.get_record(*file.hash)) {
      try {
        const std::vector<MadeProduct> made = from_record(*text);
        const auto is_named = [&](const MadeProduct& one) {
          return named.products.contains(one.product.key);
        };
        // A mask may be of many pictures: it keeps none of them.
        const bool of_named_picture =
            std::any_of(made.begin(), made.end(), [&](const MadeProduct& one) {
              return is_named(one) && (one.product.kind == "film" || one.product.kind == "image");
            });
        for (const MadeProduct& one : made) {
          if (!is_named(one) && !(of_named_picture && one.product.kind == k_sums_kind)) continue;
          found.is_named = true;
          objects.insert(one.product.object);
          products.insert(one.product.key);
        }
      } catch (const UnreadableRecord&) {
        // Of another version, which may know more of it.
        found.is_named = true;
      }
      use.files.push_back(std::move(found));
    }
  });
}

}  // namespace

StoreUse look_at_store(Store& store, Database& database, bool forget_gone,
                       const std::atomic<bool>& stop) {
  StoreUse use;
  use.datasets = datasets_of(store, database);
  use.unknown = unknown_datasets(store, use.datasets);
  const Named named = named_by(database, use.datasets, forget_gone);
  HashSet objects = named.objects, products = named.products;
  look_at_records(store, named, objects, products, use, stop);
  std::unordered_map<Hash128, std::string, HashOfHash> kinds;
  visit_products(database, [&](Hash128 key, std::string_view kind, Hash128 object) {
    if (products.contains(key)) {
      objects.insert(object);
      kinds.emplace(object, kind);
    } else {
      use.unnamed_products.push_back(key);
    }
  });
  HashSet there;
  store.visit_files(Store::Kind::object, [&](const Store::StoredFile& file) {
    if (!is_ours(file, use, stop)) return;
    const bool is_named = objects.contains(*file.hash);
    if (is_named) {
      const auto kind = kinds.find(*file.hash);
      use.by_kind[kind == kinds.end() ? "other" : kind->second].add(file.bytes);
      there.insert(*file.hash);
    }
    use.files.push_back({Store::Kind::object, *file.hash, file.bytes, file.written, is_named});
  });
  use.missing = static_cast<std::uint64_t>(
      std::count_if(named.objects.begin(), named.objects.end(),
                    [&](Hash128 object) { return !there.contains(object); }));
  return use;
}

}  // namespace ds

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

/// False for what is no object or record, which is noted.
bool is_ours(const Store::StoredFile& file, StoreUse& use, const std::atomic<bool>& stop) {
  if (stop) fail(ErrorKind::cancelled, "stopped; nothing is removed");
  if (!file.fault.empty()) {
    use.faults.push_back(fmt::format("{}: {}", file.path.string(), file.fault));
  } else if (file.is_temporary) {
    use.temporaries.push_back(file.path);
    use.temporary_bytes += file.bytes;
  } else if (!file.hash) {
    use.strangers.push_back(file.path);
  } else {
    return true;
  }
  return false;
}

/// Enters every hash that a record of another form holds: one of them may be an object's.
void name_all_hashes(const std::string& text, HashSet& objects) {
  constexpr std::size_t k_digits = 32;
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && is_digit(text[end]))
      ++end;
    if (end - at == k_digits)
      if (const auto hash = Hash128::from_hex(std::string_view(text).substr(at, k_digits)))
        objects.insert(*hash);
    at = end + 1;
  }
}

/// Whether a dataset names what the record tells of, which is entered then. The sums of a film, by
/// which it can be gone on with, are named where its film or picture is.
bool enter_named(const std::vector<MadeProduct>& made, const Named& named, HashSet& objects,
                 HashSet& products) {
  const auto is_named = [&](const MadeProduct& one) {
    return named.products.contains(one.product.key);
  };
  // A mask may be of many pictures: it keeps none of them.
  const bool of_named_picture = std::any_of(made.begin(), made.end(), [&](const MadeProduct& one) {
    return is_named(one) && (one.product.kind == "film" || one.product.kind == "image");
  });
  bool any = false;
  for (const MadeProduct& one : made) {
    if (!is_named(one) && !(of_named_picture && one.product.kind == k_sums_kind)) continue;
    any = true;
    objects.insert(one.product.object);
    products.insert(one.product.key);
  }
  return any;
}

/// Reads all records.
void look_at_records(const Store& store, const Named& named, HashSet& objects, HashSet& products,
                     StoreUse& use, const std::atomic<bool>& stop) {
  store.visit_files(Store::Kind::record, [&](const Store::StoredFile& file) {
    if (!is_ours(file, use, stop)) return;
    StoreFileUse found{Store::Kind::record, *file.hash, file.bytes, file.written, false};
    std::string text;
    const Store::Health health = store.examine(Store::Kind::record, *file.hash, &text);
    if (health == Store::Health::absent) return;  // it has just gone
    if (health == Store::Health::damaged) {
      use.faults.push_back(fmt::format("{}: is damaged", file.path.string()));
    } else {
      try {
        found.is_named = enter_named(from_record(text), named, objects, products);
      } catch (const UnreadableRecord&) {
        ++use.unreadable;
        found.is_named = true;
        name_all_hashes(text, objects);
      }
    }
    use.files.push_back(found);
  });
}

}  // namespace

StoreUse look_at_store(const Store& store, Database& database, bool forget_gone,
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

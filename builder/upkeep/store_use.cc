// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/store_use.h"

#include "builder/db/named_products.h"
#include "builder/make/image_keeper.h"
#include "builder/plan/keys.h"
#include "builder/store/killed_builds.h"
#include "builder/store/made_record.h"
#include "tracer/base/error.h"
#include "tracer/base/parallel.h"
#include "tracer/base/temporary_file.h"

#include <algorithm>
#include <optional>
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
bool is_ours(const Store::StoredFile& file, bool others_run, StoreUse& use,
             const std::atomic<bool>& stop) {
  if (stop) fail(ErrorKind::cancelled, "stopped; nothing is removed");
  if (!file.fault.empty()) {
    use.faults.push_back(fmt::format("{}: {}", file.path.string(), file.fault));
  } else if (const auto process = process_of_temporary(file.path.filename().string());
             others_run && process && is_running(*process)) {
    use.temporaries_now.add(file.bytes);
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

/// What a record says, or why it does not.
struct ReadRecord {
  Store::Health health = Store::Health::absent;
  bool is_readable = true;
  std::string text;  ///< where it is not
  std::vector<RecordLine> lines;
};

ReadRecord read_record(const Store& store, Hash128 hash) {
  ReadRecord read;
  std::string text;
  read.health = store.examine(Store::Kind::record, hash, &text);
  if (read.health != Store::Health::whole) return read;
  try {
    read.lines = record_lines(text);
    for (RecordLine& line : read.lines)
      line.text = {};  // it goes with the text
  } catch (const UnreadableRecord&) {
    read.is_readable = false;
    read.text = std::move(text);
  }
  return read;
}

/// Whether a dataset names what the record tells of, which is entered then. The sums of a film, by
/// which it can be gone on with, are named where its film or picture is.
bool enter_named(Hash128 record, const std::vector<RecordLine>& lines, const Named& named,
                 HashSet& objects, HashSet& products, StoreUse& use) {
  const auto is_named = [&](const RecordLine& line) { return named.products.contains(line.key); };
  // A mask may be of many pictures: it keeps none of them.
  const bool of_named_picture =
      std::any_of(lines.begin(), lines.end(), [&](const RecordLine& line) {
        return is_named(line) && (line.kind == "film" || line.kind == "image");
      });
  PartlyNamed partly{record, {}};
  for (const RecordLine& line : lines) {
    if (!is_named(line) && !(of_named_picture && line.kind == k_sums_kind)) {
      partly.unnamed.push_back(line.key);
      continue;
    }
    objects.insert(line.object);
    products.insert(line.key);
  }
  const bool any = partly.unnamed.size() < lines.size();
  if (any && !partly.unnamed.empty()) use.partly_named.push_back(std::move(partly));
  return any;
}

/// Reads all records, on several threads.
void look_at_records(const Store& store, const Named& named, HashSet& objects, HashSet& products,
                     bool others_run, StoreUse& use, const std::atomic<bool>& stop) {
  std::vector<Store::StoredFile> files;
  store.visit_files(Store::Kind::record, [&](const Store::StoredFile& file) {
    if (is_ours(file, others_run, use, stop)) files.push_back(file);
  });
  std::vector<ReadRecord> records(files.size());
  parallel_ranges(files.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !stop; ++i)
      records[i] = read_record(store, *files[i].hash);
  });
  if (stop) fail(ErrorKind::cancelled, "stopped; nothing is removed");
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ReadRecord& record = records[i];
    if (record.health == Store::Health::absent) continue;  // it has just gone
    StoreFileUse found{Store::Kind::record, *files[i].hash, files[i].bytes, files[i].written};
    if (record.health == Store::Health::damaged) {
      use.faults.push_back(fmt::format("{}: is damaged", files[i].path.string()));
    } else if (record.is_readable) {
      found.is_named = enter_named(found.hash, record.lines, named, objects, products, use);
    } else {
      ++use.unreadable;
      found.is_named = true;
      name_all_hashes(record.text, objects);
    }
    use.files.push_back(found);
  }
}

void look_at_database(Database& database, StoreUse& use) {
  const DatabaseSize size = size_of(database);
  use.database_bytes = size.bytes;
  use.database_free = size.free_bytes;
}

void mark_being_made(const std::vector<RunningBuild>& running, StoreUse& use) {
  if (running.empty()) return;
  const auto first = std::min_element(
      running.begin(), running.end(),
      [](const RunningBuild& a, const RunningBuild& b) { return a.since < b.since; });
  for (StoreFileUse& file : use.files)
    file.is_being_made = !file.is_named && file.written >= first->since;
}

}  // namespace

StoreUse look_at_store(const Store& store, Database& database, bool forget_gone,
                       const std::vector<RunningBuild>& running, const std::atomic<bool>& stop) {
  StoreUse use;
  look_at_database(database, use);
  use.datasets = datasets_of(store, database);
  use.unknown = unknown_datasets(store, use.datasets);
  const Named named = named_by(database, use.datasets, forget_gone);
  HashSet objects = named.objects, products = named.products;
  const bool others_run = !running.empty();
  look_at_records(store, named, objects, products, others_run, use, stop);
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
    if (!is_ours(file, others_run, use, stop)) return;
    const bool is_named = objects.contains(*file.hash);
    if (is_named) {
      const auto kind = kinds.find(*file.hash);
      use.by_kind[kind == kinds.end() ? "other" : kind->second].add(file.bytes);
      there.insert(*file.hash);
    }
    use.files.push_back({Store::Kind::object, *file.hash, file.bytes, file.written, is_named});
  });
  mark_being_made(running, use);
  use.missing = static_cast<std::uint64_t>(
      std::count_if(named.objects.begin(), named.objects.end(),
                    [&](Hash128 object) { return !there.contains(object); }));
  return use;
}

}  // namespace ds

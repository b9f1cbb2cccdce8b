// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/gather.h"

#include "builder/db/sqlite.h"
#include "builder/store/made_record.h"
#include "builder/store/store_database.h"
#include "tracer/base/error.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;
using Kind = Store::Kind;
using Health = Store::Health;

/// Together they wait once for the disk.
constexpr std::size_t k_most_together = 256;
constexpr std::size_t k_most_bytes = std::size_t{64} << 20U;

class Gathering {
 public:
  Gathering(const Store& from, Store& to, const GatherRequest& request,
            const std::atomic<bool>& stop)
      : from_(from), to_(to), request_(request), stop_(stop) {}

  GatherResult run();

 private:
  /// A record under way, and its objects that the other store lacks.
  struct Pending {
    Hash128 hash;
    std::string text;
  };
  void look_at(Hash128 record);
  void take_object(Hash128 object);
  void fault(Kind kind, Hash128 hash, const std::string& why);
  std::vector<Hash128> records_of_other();
  void flush();
  void remove(Kind kind, Hash128 hash);
  void count_unrecorded();

  const Store& from_;
  Store& to_;
  const GatherRequest& request_;
  const std::atomic<bool>& stop_;
  GatherResult result_;
  std::set<Hash128> seen_;  ///< objects that records name
  std::vector<Pending> records_;
  std::vector<std::pair<Hash128, std::string>> objects_;
  std::vector<Hash128> named_;  ///< by the records under way, and whole in the other store then
  std::size_t bytes_ = 0;
};

std::string name_of(const Store& store, Kind kind, Hash128 hash) {
  const std::string hex = hash.hex();
  return (store.folder() / (kind == Kind::object ? "objects" : "records") / hex.substr(0, 2) /
          hex.substr(2))
      .string();
}

/// Nothing where there is no such file.
std::optional<std::uint64_t> size_of(const Store& store, Hash128 object) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(name_of(store, Kind::object, object), error);
  return error ? std::nullopt : std::optional<std::uint64_t>(size);
}

void Gathering::fault(Kind kind, Hash128 hash, const std::string& why) {
  result_.faults.push_back(fmt::format("{}: {}", name_of(from_, kind, hash), why));
}

void Gathering::take_object(Hash128 object) {
  if (!seen_.insert(object).second) return;
  std::string bytes;
  if (to_.intact(object)) {
    result_.there.add(size_of(to_, object).value_or(0));
    named_.push_back(object);
    return;
  }
  Health health = Health::absent;
  try {
    health = from_.examine(Kind::object, object, &bytes);
  } catch (const Error& error) {
    return fault(Kind::object, object, error.what());
  }
  if (health == Health::damaged) {
    fault(Kind::object, object, "is damaged");
    if (request_.move) remove(Kind::object, object);
  }
  // Another may just have moved it.
  if (health == Health::absent && !to_.has(object)) ++result_.missing;
  if (health != Health::whole) return;
  result_.objects.add(bytes.size());
  bytes_ += bytes.size();
  named_.push_back(object);
  objects_.emplace_back(object, std::move(bytes));
}

void Gathering::look_at(Hash128 record) {
  Pending pending{record, {}};
  Health health = Health::absent;
  try {
    health = from_.examine(Kind::record, record, &pending.text);
  } catch (const Error& error) {
    return fault(Kind::record, record, error.what());
  }
  if (health == Health::damaged) {
    fault(Kind::record, record, "is damaged");
    if (request_.move) remove(Kind::record, record);
  }
  if (health != Health::whole) return;
  try {
    for (const MadeProduct& made : from_record(pending.text))
      take_object(made.product.object);
  } catch (const UnreadableRecord& error) {
    return fault(Kind::record, record, error.what());
  }
  records_.push_back(std::move(pending));
}

/// A disk that refuses to let a file go is no reason to end: the other store has it.
void Gathering::remove(Kind kind, Hash128 hash) {
  std::error_code ignored;
  fs::remove(name_of(from_, kind, hash), ignored);
}

/// Writes what is under way; only then does anything go.
void Gathering::flush() {
  std::vector<Store::NewObject> objects;
  for (const auto& [hash, bytes] : objects_)
    objects.push_back({hash, bytes_of(bytes)});
  std::vector<std::string> records;
  for (const Pending& record : records_) {
    if (to_.examine(Kind::record, record.hash) == Health::whole) {
      result_.there.add(record.text.size());
    } else {
      result_.records.add(record.text.size());
      records.push_back(record.text);
    }
  }
  to_.put_all(objects, {});
  to_.put_all({}, records);
  if (request_.database != nullptr) {
    Transaction transaction(request_.database->connection());
    for (const Pending& record : records_)
      enter_record(*request_.database, record.text);
    transaction.commit();
  }
  if (request_.move) {
    for (const Pending& record : records_)
      remove(Kind::record, record.hash);
    for (const Hash128 object : named_)
      remove(Kind::object, object);
  }
  records_.clear();
  objects_.clear();
  named_.clear();
  bytes_ = 0;
}

void Gathering::count_unrecorded() {
  from_.visit_files(Kind::object, [&](const Store::StoredFile& file) {
    if (file.hash && file.fault.empty() && !seen_.contains(*file.hash))
      result_.unrecorded.add(file.bytes);
  });
}

std::vector<Hash128> Gathering::records_of_other() {
  std::vector<Hash128> all;
  from_.visit_files(Kind::record, [&](const Store::StoredFile& file) {
    if (!file.fault.empty())
      result_.faults.push_back(fmt::format("{}: {}", file.path.string(), file.fault));
    else if (file.hash)
      all.push_back(*file.hash);
  });
  return all;
}

GatherResult Gathering::run() {
  const std::vector<Hash128> all = records_of_other();
  std::uint64_t done = 0;
  for (const Hash128 record : all) {
    if (stop_)
      fail(ErrorKind::cancelled, "stopped; what was taken is whole, run it again to go on");
    look_at(record);
    if (records_.size() >= k_most_together || bytes_ >= k_most_bytes) flush();
    if (request_.progress) request_.progress(++done, all.size());
  }
  flush();
  count_unrecorded();
  return result_;
}

}  // namespace

GatherResult gather(const Store& from, Store& to, const GatherRequest& request,
                    const std::atomic<bool>& stop) {
  return Gathering(from, to, request, stop).run();
}

}  // namespace ds

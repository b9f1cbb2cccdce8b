// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/gathering.h"

#include "builder/cmd/named_store.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/work_progress.h"
#include "builder/store/killed_builds.h"
#include "builder/store/store_database.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Faults named in full; what follows is counted.
constexpr std::size_t k_most_faults = 20;

void warn_of_faults(const GatherResult& result) {
  for (std::size_t i = 0; i < std::min(result.faults.size(), k_most_faults); ++i)
    warn(fmt::format("{}; not taken", result.faults[i]));
  if (result.faults.size() > k_most_faults)
    warn(fmt::format("and {} more", result.faults.size() - k_most_faults));
}

BroughtHome bring_home(Store& store, Disk& disk) {
  BroughtHome brought;
  remove_temporaries(store.local());
  const Store local(store.local(), disk);
  Store home(store.folder(), disk);
  const std::atomic<bool> never{false};  // whoever stops the build wants what it made
  try {
    brought.result =
        gather(local, home, {.move = true, .database = nullptr, .progress = {}}, never);
    warn_of_faults(*brought.result);
  } catch (const Error& error) {
    brought.failed = fmt::format(
        "{} (what was made stays in {}; the next build with it as --local brings it, or dsbuild "
        "store "
        "gather)",
        error.what(), store.local().string());
  }
  return brought;
}

/// Whether nothing is there, or the lock alone of who is about to make a store of it.
bool is_new(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return true;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error))
    if (entry->path().filename() != "lock") return false;
  return !error;
}

/// Of a folder that is a store, or is to become one.
fs::path taking_store(const std::string& to, Disk& disk) {
  fs::path folder = fs::absolute(to).lexically_normal();
  // First: who makes it makes what a store has next.
  return is_new(folder) ? folder : named_store(folder.string(), "store gather", disk);
}

void check_two(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (fs::equivalent(from, to, error))
    fail(ErrorKind::usage, "store gather: wanted two stores, got {} twice", to.string());
}

}  // namespace

nlohmann::json to_json(const Amount& amount) {
  return {{"files", amount.files}, {"bytes", amount.bytes}};
}

nlohmann::json to_json(const GatherResult& result) {
  return {{"objects", to_json(result.objects)}, {"records", to_json(result.records)},
          {"there", to_json(result.there)},     {"unrecorded", to_json(result.unrecorded)},
          {"faults", result.faults.size()},     {"missing", result.missing}};
}

BroughtHome work_and_bring_home(Store& store, Disk& disk, const std::function<void()>& work) {
  if (store.local().empty()) {
    work();
    return {};
  }
  try {
    work();
  } catch (...) {
    if (const BroughtHome brought = bring_home(store, disk); !brought.failed.empty())
      warn(brought.failed);
    throw;
  }
  return bring_home(store, disk);
}

int run_gather(const Arguments& arguments, const fs::path& from, Disk& disk) {
  if (arguments.other.empty())
    fail(ErrorKind::usage,
         "store gather: wanted the store that takes it, too: dsbuild store gather {} TO",
         arguments.target);
  const fs::path folder = taking_store(arguments.other, disk);
  check_two(from, folder);
  const Store source(from, disk);
  Store target(folder, disk);
  // With a database of its own, other machines may write to it: no lock of it tells of them.
  std::unique_ptr<Claims> claims;
  std::unique_ptr<Database> database;
  if (arguments.database_folder.empty()) {
    if (const auto mark = find_slurm_mark(target))
      refuse_filled_store(*mark, "store gather without --database");
    claims = std::make_unique<Claims>(folder / "lock");
    database = open_database(target, *claims);
  }
  const std::atomic<bool>& stop = stop_on_signal();
  GatherResult result;
  {
    WorkProgress progress("records gathered");
    result =
        gather(source, target,
               {.move = false,
                .database = database.get(),
                .progress = [&](std::uint64_t done, std::uint64_t all) { progress(done, all); }},
               stop);
  }
  warn_of_faults(result);
  if (arguments.json)
    print_json(to_json(result));
  else
    say(Stream::report,
        "{}: {} objects and {} records taken from {}, {:.1f} MB; {} files it had already{}{}\n",
        folder.string(), result.objects.files, result.records.files, from.string(),
        static_cast<double>(result.objects.bytes + result.records.bytes) / 1e6, result.there.files,
        result.missing > 0
            ? fmt::format(
                  "; {} objects that records name are in neither, as after store gc (dsbuild build "
                  "makes what is wanted of them)",
                  result.missing)
            : "",
        result.unrecorded.files > 0
            ? fmt::format("; {} objects that no record names are left", result.unrecorded.files)
            : "");
  return result.faults.empty() ? 0 : 1;
}

}  // namespace ds

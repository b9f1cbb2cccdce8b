// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/gathering.h"
#include "builder/cmd/named_store.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "builder/forecast/budget.h"
#include "builder/store/guest.h"
#include "builder/store/parts.h"
#include "builder/store/store_database.h"
#include "builder/upkeep/collect.h"
#include "builder/upkeep/restore.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/nearest.h"
#include "tracer/base/shell_quoted.h"
#include "tracer/base/streams.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <thread>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// A store by itself, whatever datasets it has.
struct OpenStore {
  std::unique_ptr<Store> store;
  std::unique_ptr<Claims> claims;  ///< null where nobody may write
  std::unique_ptr<Database> database;
};

fs::path store_folder_of(const Arguments& arguments, Disk& disk) {
  return named_store(arguments.target, "store " + arguments.store_task, disk);
}

/// What the jobs made is of no dataset that the database knows before a build places it.
void refuse_gc(const SlurmMark& mark) {
  refuse_filled_store(mark, "store gc");
  fail(ErrorKind::usage,
       "{}: {}, ended before the dataset was whole, and gc would remove what they made: go on by "
       "dsbuild slurm, or by dsbuild build {} with the -o, --store, --set it had and --database, "
       "then "
       "collect; or remove {} to give that up",
       mark.file.parent_path().parent_path().string(), jobs_text(mark),
       shell_quoted(mark.recipe.string()), mark.file.string());
}

/// What a store is opened for.
enum class Opening {
  look,      ///< beside whoever has it open
  collect,   ///< alone: waits for whoever has the database open, and others wait then
  forecast,  ///< as look, but refused where `collect` is, and what that would wait for is said
};

void wait_for_others(Claims& claims, const fs::path& folder) {
  const std::atomic<bool>& stop = stop_on_signal();
  for (bool told = false; !claims.try_own_database(); told = true) {
    if (stop) fail(ErrorKind::cancelled, "stopped; nothing is removed");
    if (!told) warn(fmt::format("{}: waits for what has the store open", folder.string()));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

OpenStore open_store(const Arguments& arguments, Opening opening, Disk& disk) {
  const fs::path folder = store_folder_of(arguments, disk);
  OpenStore open{std::make_unique<Store>(folder, disk), nullptr, nullptr};
  if (arguments.store_task != "verify") open.store->leave_damage();
  const std::optional<SlurmMark> mark = find_slurm_mark(*open.store);
  if (opening != Opening::look && mark) refuse_gc(*mark);
  if (mark || is_read_only(folder)) {
    if (opening != Opening::look) fail(ErrorKind::io, "{}: may not be written to", folder.string());
    open.database = open_database_copy(*open.store, mark.has_value());
    return open;
  }
  open.claims = std::make_unique<Claims>(folder / "lock");
  if (opening == Opening::collect) {
    wait_for_others(*open.claims, folder);
    open.database = open_own_database(*open.store);
    return open;
  }
  if (opening == Opening::forecast && !open.claims->try_own_database())
    warn(
        fmt::format("{}: gc would wait for what has the store open, and may then find more that "
                    "is named",
                    folder.string()));
  open.database = open_database(*open.store, *open.claims);
  return open;
}

/// Builds that others are to complete named nothing yet.
void check_no_parts(const Store& store) {
  for (const Parts& parts : find_parts(store))
    fail(ErrorKind::usage,
         "{0}: builds of a part (--shard, --no-files) of the recipe {1} made things here that no "
         "build has placed yet, and gc would remove them: place them by dsbuild build {1} --store "
         "{0}, then collect; or remove {2} to give them up",
         store.folder().string(), parts.recipe, parts.file.string());
}

/// A database that was lost and made anew does not know what datasets name until they are built.
void check_all_known(const Store& store, const StoreUse& use) {
  if (!use.unknown.empty())
    fail(ErrorKind::usage,
         "{}: does not know what the dataset in {} names, as after its database was lost: build it "
         "once, "
         "then collect",
         store.folder().string(), use.unknown.front().string());
  if (use.datasets.empty() && !use.files.empty())
    fail(ErrorKind::usage,
         "{}: knows no dataset, so all of it would go: build one first, or remove the folder",
         store.folder().string());
}

/// What lies in a store and is none of its files, or not whole.
void warn_of_strange(const Store& store, const StoreUse& use) {
  constexpr std::size_t k_most = 20;
  for (std::size_t i = 0; i < std::min(use.faults.size(), k_most); ++i)
    warn(fmt::format("{} (dsbuild store verify)", use.faults[i]));
  if (use.faults.size() > k_most) warn(fmt::format("and {} more", use.faults.size() - k_most));
  if (use.unreadable > 0)
    warn(
        fmt::format("{}: {} records of another dsbuild's form, left as they are, with all objects "
                    "whose hashes they hold",
                    store.folder().string(), use.unreadable));
  if (!use.strangers.empty())
    warn(fmt::format(
        "{}: no file of the store's, left alone{}", use.strangers.front().string(),
        use.strangers.size() > 1 ? fmt::format(", and {} more", use.strangers.size() - 1) : ""));
}

/// Who may put files into the store now.
std::vector<RunningBuild> running_in(const OpenStore& open) {
  std::vector<RunningBuild> running = running_builds(*open.store, *open.database);
  const std::optional<SlurmMark> mark = find_slurm_mark(*open.store);
  std::error_code gone;
  // It is written again once the first jobs may have begun.
  if (mark)
    running.push_back(
        {to_text(*mark), fs::last_write_time(mark->file, gone) - std::chrono::minutes(1)});
  return running;
}

nlohmann::json names_of(const std::vector<RunningBuild>& running) {
  nlohmann::json names = nlohmann::json::array();
  for (const RunningBuild& build : running)
    names.push_back(build.who);
  return names;
}

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

std::string amount_text(const Amount& amount) {
  return fmt::format("{} files, {}", amount.files, megabytes(amount.bytes));
}

void say_running(const std::vector<RunningBuild>& running, const Amount& being_made) {
  for (const RunningBuild& build : running)
    say(Stream::result, "  at work: {}\n", build.who);
  if (!running.empty())
    say(Stream::result, "  written since, and named by no dataset yet: {}\n",
        amount_text(being_made));
}

/// "20G", "500M", "1000": powers of 1,000.
std::uint64_t parse_bytes(const std::string& text) {
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  const std::string unit(end, text.data() + text.size());
  static constexpr std::array<std::pair<std::string_view, double>, 5> k_units{
      {{"", 1}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9}, {"T", 1e12}}};
  for (const auto& [name, factor] : k_units)
    if (error == std::errc() && unit == name && value >= 0 && value * factor < 1e18)
      return static_cast<std::uint64_t>(value * factor);
  fail(ErrorKind::usage, "store --size: wanted a number of bytes such as 500M or 20G, got {}",
       text);
}

int run_stats(const Arguments& arguments, Disk& disk) {
  const OpenStore open = open_store(arguments, Opening::look, disk);
  const std::vector<Parts> all_parts = find_parts(*open.store);
  const std::vector<RunningBuild> running = running_in(open);
  const StoreUse use =
      look_at_store(*open.store, *open.database, arguments.forget, running, stop_on_signal());
  warn_of_strange(*open.store, use);
  Amount objects, records, unnamed, being_made = use.temporaries_now;
  for (const StoreFileUse& file : use.files) {
    (file.kind == Store::Kind::object ? objects : records).add(file.bytes);
    if (!file.is_named) (file.is_being_made ? being_made : unnamed).add(file.bytes);
  }
  nlohmann::json datasets = nlohmann::json::array(), kinds = nlohmann::json::object();
  for (const DatasetUse& dataset : use.datasets)
    datasets.push_back({{"name", dataset.row.name},
                        {"recipe", dataset.row.recipe.string()},
                        {"folder", dataset.folder.string()},
                        {"gone", dataset.is_gone},
                        {"images", dataset.images}});
  for (const auto& [kind, amount] : use.by_kind)
    kinds[kind] = to_json(amount);
  nlohmann::json elsewhere = nlohmann::json::array();
  for (const fs::path& folder : use.unknown)
    elsewhere.push_back(folder.string());
  nlohmann::json unplaced = nlohmann::json::array();
  for (const Parts& parts : all_parts)
    unplaced.push_back(parts.recipe);
  if (arguments.json) {
    print_json({{"store", open.store->folder().string()},
                {"datasets", datasets},
                {"objects", to_json(objects)},
                {"records", to_json(records)},
                {"named", kinds},
                {"unnamed", to_json(unnamed)},
                {"running", names_of(running)},
                {"being_made", to_json(being_made)},
                {"database", {{"bytes", use.database_bytes}, {"free", use.database_free}}},
                {"missing", use.missing},
                {"faults", use.faults.size()},
                {"unreadable_records", use.unreadable},
                {"strangers", use.strangers.size()},
                {"elsewhere", elsewhere},
                {"parts", unplaced},
                {"temporaries", to_json(Amount{use.temporaries.size(), use.temporary_bytes})}});
    return 0;
  }
  say(Stream::result, "{}\n", open.store->folder().string());
  for (const DatasetUse& dataset : use.datasets)
    say(Stream::result, "  {}: {} images, {}{}\n", dataset.row.name, dataset.images,
        dataset.folder.empty() ? "in a folder that its next build tells" : dataset.folder.string(),
        dataset.is_gone ? ", which is gone (gc --forget)" : "");
  for (const Parts& parts : all_parts)
    say(Stream::result,
        "  {}: builds of a part (--shard, --no-files), which a build of all images is to place\n",
        parts.recipe);
  if (use.datasets.empty() && use.unknown.empty() && all_parts.empty() && !use.files.empty())
    say(Stream::result, "  it knows no dataset\n");
  for (const fs::path& folder : use.unknown)
    say(Stream::result,
        "  {}: a dataset whose builds keep their database elsewhere (--database), or built before "
        "this one was lost: what it names is not known here\n",
        folder.string());
  for (const auto& [kind, amount] : use.by_kind)
    say(Stream::result, "  {}: {}\n", kind, amount_text(amount));
  say(Stream::result, "  {}: {}\n",
      use.unknown.empty() ? "no dataset names" : "no dataset that is known names",
      amount_text(unnamed));
  say_running(running, being_made);
  say(Stream::result, "  all objects: {}; records: {}; database: {}{}\n", amount_text(objects),
      amount_text(records), megabytes(use.database_bytes),
      use.database_free > 0
          ? fmt::format(", of which {} hold nothing", megabytes(use.database_free))
          : "");
  if (use.missing > 0)
    say(Stream::result,
        "  {} objects that datasets name are missing (store verify puts back what their folders "
        "have of them, dsbuild build makes the rest)\n",
        use.missing);
  if (!use.temporaries.empty())
    say(Stream::result, "  left by killed builds: {}\n",
        amount_text({use.temporaries.size(), use.temporary_bytes}));
  return 0;
}

int run_gc(const Arguments& arguments, Disk& disk) {
  CollectRequest request{std::chrono::seconds(0), std::nullopt, arguments.forget,
                         arguments.dry_run};
  if (!arguments.older.empty()) {
    const std::optional<double> seconds = parse_duration(arguments.older);
    if (!seconds)
      fail(ErrorKind::usage, "store --older: wanted a time such as 30d, 12h or 90m, got {}",
           arguments.older);
    request.older = std::chrono::seconds(static_cast<std::int64_t>(*seconds));
  }
  if (!arguments.size.empty()) request.most_bytes = parse_bytes(arguments.size);
  const OpenStore open =
      open_store(arguments, arguments.dry_run ? Opening::forecast : Opening::collect, disk);
  std::optional<Guest> guest;
  if (arguments.dry_run)
    Guest::check_collect(*open.store);
  else
    guest.emplace(Guest::collect(*open.store));
  check_no_parts(*open.store);
  // Beside gc itself nobody is.
  const std::vector<RunningBuild> running =
      arguments.dry_run ? running_in(open) : std::vector<RunningBuild>{};
  const StoreUse use =
      look_at_store(*open.store, *open.database, arguments.forget, running, stop_on_signal());
  check_all_known(*open.store, use);
  warn_of_strange(*open.store, use);
  const CollectResult result = collect(*open.store, *open.database, request, use);
  if (!result.not_shrunk.empty())
    warn(fmt::format("the database stays as large as it is: {}", result.not_shrunk));
  if (arguments.json) {
    print_json({{"objects", to_json(result.objects)},
                {"records", to_json(result.records)},
                {"temporaries", to_json(result.temporaries)},
                {"kept", to_json(result.kept)},
                {"unnamed", to_json(result.unnamed)},
                {"running", names_of(running)},
                {"being_made", to_json(result.being_made)},
                {"forgotten", result.forgotten},
                {"products", result.products},
                {"texts", result.texts},
                {"lines", result.lines},
                {"database", result.database_bytes},
                {"database_left",
                 result.database_left ? nlohmann::json(*result.database_left) : nlohmann::json()},
                {"faults", use.faults.size()},
                {"unreadable_records", use.unreadable},
                {"strangers", use.strangers.size()},
                {"dry_run", arguments.dry_run}});
    return 0;
  }
  const std::uint64_t database = result.database_left.value_or(result.database_bytes);
  say(Stream::report, "{} objects ({}), {} records{}{}; {} left, and a database of {}\n",
      arguments.dry_run ? "would remove" : "removed", amount_text(result.objects),
      result.records.files,
      result.lines > 0 ? fmt::format(", {} lines of others", result.lines) : "",
      result.forgotten > 0 ? fmt::format(", {} datasets forgotten", result.forgotten) : "",
      amount_text(result.kept), megabytes(database));
  if (!running.empty())
    say(Stream::report,
        "of what is left, {} are named by no dataset and were written since {} began\n",
        amount_text(result.being_made), running.front().who);
  if (request.most_bytes && result.kept.bytes + database > *request.most_bytes)
    warn(fmt::format(
        "{}: takes more than --size {}: the rest is what datasets name, or not old enough",
        open.store->folder().string(), arguments.size));
  for (const DatasetUse& dataset : use.datasets)
    if (dataset.is_gone && !arguments.forget)
      warn(
          fmt::format("{}: nothing of the dataset {} lies there any more; --forget removes what it "
                      "alone names",
                      dataset.folder.string(), dataset.row.name));
  return 0;
}

enum class Found { whole, removed, left };

/// Only looks with `dry`; else removes a damaged file, and one that has gone meanwhile counts as removed.
/// Each is said.
Found read_and_remove(Store& store, Store::Kind kind, Hash128 hash, bool dry) {
  try {
    if (dry) {
      const Store::Health health = store.examine(kind, hash);
      if (health == Store::Health::damaged)
        warn(fmt::format("{} {} is damaged, and stays",
                         kind == Store::Kind::object ? "object" : "record", hash.hex()));
      return health == Store::Health::damaged ? Found::left
             : health == Store::Health::whole ? Found::whole
                                              : Found::removed;
    }
    if (kind == Store::Kind::object ? store.intact(hash) : store.get_record(hash).has_value())
      return Found::whole;
    return store.examine(kind, hash) == Store::Health::damaged ? Found::left : Found::removed;
  } catch (const Error& error) {  // cannot be read at all
    warn(error.what());
    return Found::left;
  }
}

int run_store_gather(const Arguments& arguments, Disk& disk) {
  return run_gather(arguments, store_folder_of(arguments, disk), disk);
}

/// What is missing of what datasets name, and what then follows.
std::string missing_text(std::uint64_t missing, std::uint64_t restored, bool looks) {
  std::string text = fmt::format("{} objects that datasets name are missing", missing);
  if (restored > 0)
    text = fmt::format("{} objects put back from datasets' folders; ", restored) + text;
  if (missing > 0)
    text += looks ? "; store verify without -n puts back what datasets' folders have of them"
                  : "; dsbuild build of their datasets, which lack them, too, makes them again";
  return text;
}

int run_store_verify(const Arguments& arguments, Disk& disk) {
  const OpenStore open = open_store(arguments, Opening::look, disk);
  const std::atomic<bool>& stop = stop_on_signal();
  std::vector<std::pair<Store::Kind, Hash128>> all;
  std::uint64_t left = 0, done = 0;
  for (const Store::Kind kind : {Store::Kind::object, Store::Kind::record})
    open.store->visit_files(kind, [&](const Store::StoredFile& file) {
      if (file.hash) all.emplace_back(kind, *file.hash);
      if (file.hash || file.fault.empty()) return;
      warn(fmt::format("{}: {}, and stays (move it away)", file.path.string(), file.fault));
      ++left;
    });
  std::uint64_t damaged = left;
  {
    WorkProgress progress("files of the store read");
    for (const auto& [kind, hash] : all) {
      if (stop) fail(ErrorKind::cancelled, "stopped");
      const Found found = read_and_remove(*open.store, kind, hash, arguments.dry_run);
      damaged += found == Found::whole ? 0U : 1U;
      left += found == Found::left ? 1U : 0U;
      progress(++done, all.size());
    }
  }
  const bool mends = !arguments.dry_run && !is_read_only(open.store->folder());
  const std::uint64_t restored = mends ? restore_objects(*open.store, *open.database, stop) : 0;
  const std::uint64_t missing =
      look_at_store(*open.store, *open.database, arguments.forget, {}, stop).missing;
  if (arguments.json)
    print_json({{"files", all.size()},
                {"damaged", damaged},
                {"not_removed", left},
                {"restored", restored},
                {"missing", missing}});
  else
    say(Stream::report, "{} files read, {} damaged{}; {}\n", all.size(), damaged,
        arguments.dry_run ? ""
        : left > 0        ? fmt::format(" ({} of them could not be removed)", left)
                          : " and removed",
        missing_text(missing, restored, !mends));
  return damaged + restored + missing > 0 ? 1 : 0;
}

constexpr std::array<StoreTask, 4> k_tasks{{
    {"stats", "what is in it, and for which datasets", false, run_stats},
    {"gc", "remove what none of them names", true, run_gc},
    {"verify", "read every file, remove what is damaged, put back what folders have of that", true,
     run_store_verify},
    {"gather", "take what it has into another", false, run_store_gather},
}};

}  // namespace

std::span<const StoreTask> store_tasks() {
  return k_tasks;
}

int run_store(const Arguments& arguments) {
  RealDisk disk;
  std::vector<std::string_view> known;
  for (const StoreTask& one : k_tasks)
    known.emplace_back(one.name);
  const auto* const task = std::find_if(k_tasks.begin(), k_tasks.end(), [&](const auto& one) {
    return one.name == arguments.store_task;
  });
  if (task == k_tasks.end())
    fail(ErrorKind::usage, "store: wanted {}, got {}{}", fmt::format("{}", fmt::join(known, ", ")),
         arguments.store_task, did_you_mean(arguments.store_task, known));
  if (arguments.store_task != "gc" && (!arguments.older.empty() || !arguments.size.empty()))
    fail(ErrorKind::usage, "store {}: --older and --size are for gc", arguments.store_task);
  if (arguments.store_task != "gather" &&
      (!arguments.other.empty() || !arguments.database_folder.empty()))
    fail(ErrorKind::usage, "store {}: a second store and --database are for gather",
         arguments.store_task);
  if (arguments.store_task != "gc" && arguments.forget)
    fail(ErrorKind::usage, "store {}: --forget is for gc", arguments.store_task);
  if (!task->takes_dry_run && arguments.dry_run)
    fail(ErrorKind::usage, "store {}: --dry-run is for gc and verify", arguments.store_task);
  return task->run(arguments, disk);
}

}  // namespace ds

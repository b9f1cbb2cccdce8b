// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/concerns_text.h"
#include "builder/cmd/gathering.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/supervisor.h"
#include "builder/cmd/verbs.h"
#include "builder/make/execute.h"
#include "builder/make/sole_plan.h"
#include "builder/plan/lacking.h"
#include "builder/store/guest.h"
#include "builder/store/parts.h"
#include "builder/store/store_database.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <set>
#include <utility>

namespace ds {
namespace {

nlohmann::json to_json(const BuildResult& result, const Dataset& dataset) {
  nlohmann::json failures = nlohmann::json::array();
  for (const auto& [what, why] : result.failures)
    failures.push_back({{"what", what}, {"why", why}});
  nlohmann::json capped = nlohmann::json::array();
  for (const auto& [id, error] : result.capped)
    capped.push_back({{"id", id}, {"error", error}});
  return {{"images", result.images},
          {"built", result.built},
          {"reused", result.reused},
          {"failed", result.failed},
          {"not_reached", result.not_reached},
          {"removed_files", result.removed_files},
          {"traced", result.traced},
          {"developed", result.developed},
          {"traced_samples", result.traced_samples},
          {"deaths", result.deaths},
          {"seconds", result.seconds},
          {"device", result.device},
          {"programs", result.programs.programs},
          {"programs_compiled", result.programs.compiled},
          {"programs_ahead", result.programs.ahead},
          {"stopped", result.stopped},
          {"disk_failed", result.disk_failed},
          {"concerns", to_json(result.concerns)},
          {"failures", failures},
          {"capped", capped},
          {"folder", dataset.folder.string()}};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The pictures that are less exact than the recipe wants, worst first.
void print_capped(BuildResult result, const Recipe& recipe) {
  if (result.capped.empty()) return;
  std::stable_sort(result.capped.begin(), result.capped.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  say(Stream::report, "{} of {} images did not reach engine.error = {} with engine.max_spp = {}:\n",
      result.capped.size(), result.images, recipe.engine.target->error,
      recipe.engine.target->max_spp);
  for (const auto& [id, error] : result.capped)
    say(Stream::report, "  {}: {:.4f}\n", id, error);
}

void print_result(const BuildResult& result, const Dataset& dataset) {
  const std::string from_store =
      result.traced == result.built ? ""
      : result.traced == 0          ? " from the store"
                           : fmt::format(" ({} traced, the others from the store)", result.traced);
  std::string text =
      fmt::format("{}: {} images: {} built{}, {} reused, {} failed", dataset.recipe.name,
                  result.images, result.built, from_store, result.reused, result.failed);
  if (result.not_reached > 0)
    text += fmt::format(", {} not reached{}", result.not_reached,
                        result.stopped || result.disk_failed ? "" : " (-k makes what can be made)");
  if (result.removed_files > 0)
    text += fmt::format(", {} file{} removed that no image of the recipe has", result.removed_files,
                        result.removed_files == 1 ? "" : "s");
  if (result.deaths > 0)
    text += fmt::format(", {} process{} died on the way", result.deaths,
                        result.deaths == 1 ? "" : "es");
  text += fmt::format(", in {:.1f} s", result.seconds);
  if (result.traced_samples > 0)
    text += fmt::format("; {} traced on {}", format_samples(result.traced_samples), result.device);
  say(Stream::report, "{}\n", text);
  print_capped(result, dataset.recipe);
  // Where nothing could be made they are not there.
  std::error_code error;
  for (const auto& [name, path] : {std::pair{"pictures", dataset.folder / "images"},
                                   std::pair{"manifest", dataset.folder / "manifest/images.jsonl"}})
    if (std::filesystem::exists(path, error)) say(Stream::report, "{}: {}\n", name, path.string());
}

/// What was wrong with the models of the shard's images: a line each, but one for all whose
/// triangles were only turned outwards, as of every third benchmark model some were.
void warn_of_mended(const Plan& plan) {
  std::set<std::string> shown;
  std::uint64_t turned_models = 0, turned = 0;
  for (const PlannedImage& image : plan.images) {
    const auto mended = plan.mended.find(image.spec.model_name);
    if (image.elsewhere || mended == plan.mended.end()) continue;
    if (!shown.insert(mended->first).second) continue;
    MendedDamage damage = mended->second.damage;
    for (const auto& [what, count] : damage)
      if (what == k_turned_outwards) {
        ++turned_models;
        turned += count;
      }
    std::erase_if(damage, [](const auto& what) { return what.first == k_turned_outwards; });
    if (!damage.empty())
      warn(fmt::format("{}: mended: {}", mended->second.file.string(), to_text(damage)));
  }
  if (turned_models > 0)
    warn(
        fmt::format("{} model{} with closed surfaces that face inwards: mended, {} triangle{} "
                    "turned outwards (dsbuild models lists them as flipped)",
                    turned_models, turned_models == 1 ? "" : "s", turned, turned == 1 ? "" : "s"));
}

nlohmann::json to_json(const std::vector<Lacking>& all) {
  nlohmann::json list = nlohmann::json::array();
  for (const Lacking& lacking : all)
    list.push_back(
        {{"material", lacking.material}, {"reads", lacking.reads}, {"models", lacking.models}});
  return list;
}

int dry_run(const Arguments& arguments, const Recipe& recipe, const Plan& plan,
            const BuildOptions& options) {
  const std::vector<Concern> concerns = tell_planned_concerns(recipe, plan);
  print_plan(arguments.json ? Stream::people : Stream::result, plan, arguments.verbose);
  const PlanCounts counts = count(plan);
  if (arguments.json)
    print_json({{"images", counts.images},
                {"built", 0},
                {"reused", counts.up_to_date},
                {"failed", counts.failed},
                {"stale", counts.stale},
                {"manifest", to_json(plan.manifest)},
                {"edited_files", plan.edited.size()},
                {"concerns", to_json(concerns)},
                {"traced_samples", 0},
                {"seconds", seconds_since(options.started)}});
  else {
    say(Stream::result, "{}\n", summary(counts));
    print_manifest_line(plan);
    print_edited(plan);
  }
  return counts.failed > 0 ? 1 : 0;
}

/// What goes together, and what does not.
void check_options(const Arguments& arguments) {
  if (!arguments.local_folder.empty() && arguments.database_folder.empty())
    fail(
        ErrorKind::usage,
        "build --local: wants --database DIR too, as every build of a store where several machines "
        "write");
  if (arguments.no_files && arguments.copy)
    fail(ErrorKind::usage,
         "build: --no-files places no file and --copy says how; give one of them");
}

/// What is moved into a store must not lie in it.
void check_local(const Store& store) {
  std::error_code error;
  if (store.local() == store.folder() ||
      std::filesystem::equivalent(store.local(), store.folder(), error))
    fail(ErrorKind::usage, "build --local: wanted another folder than the store's, got {}",
         store.local().string());
}

/// A store that jobs of Slurm filled until they ended is whole now.
void remove_mark(const Dataset& dataset) {
  const std::optional<SlurmMark> mark = find_slurm_mark(*dataset.store);
  std::error_code ignored;
  if (mark && mark->folder == dataset.folder) std::filesystem::remove(mark->file, ignored);
}

/// A store that may not be written to is enough where it has all.
void check_can_keep(const Store& store, const Plan& plan) {
  const auto makes = [](const PlannedImage& image) {
    return std::any_of(image.files.begin(), image.files.end(),
                       [](const PlannedFile& file) { return file.state == FileState::to_make; });
  };
  if (const auto count = std::count_if(plan.images.begin(), plan.images.end(), makes); count > 0)
    refuse_read_only(store.folder(), fmt::format("of {} of {} images it has not all, and a build "
                                                 "keeps there what it makes",
                                                 count, plan.images.size()));
}

/// Where no lock in the store tells of this build. Jobs of Slurm have a mark for all of them.
std::optional<Guest> enter_as_guest(const Arguments& arguments, const Dataset& dataset) {
  if (arguments.database_folder.empty() || find_slurm_mark(*dataset.store)) return std::nullopt;
  return Guest::build(*dataset.store, dataset.recipe.file.string(), [&](const std::string& who) {
    say(Stream::people, "dsbuild: {}: waits for dsbuild store gc, {}\n",
        dataset.store->folder().string(), who);
  });
}

}  // namespace

int run_build(const Arguments& arguments) {
  expect_signs_of_life(arguments.stall_seconds);
  check_options(arguments);
  const Wanted wanted = arguments.no_files ? Wanted::store : Wanted::files;
  const EarlierProcesses earlier = earlier_processes();
  const BuildOptions build_options{
      arguments.keep_going, arguments.force, arguments.copy, wanted, earlier, earlier.began};
  // What the command is for lies in files: a reader of its text who goes away does not end it.
  if (!arguments.dry_run) std::signal(SIGPIPE, SIG_IGN);
  const Shard shard = shard_of(arguments);
  RealDisk disk;
  if (arguments.dry_run) {
    Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
    Inputs inputs(*dataset.database, stamps_of(arguments));
    const Plan plan = make_plan(dataset, inputs, arguments.force, shard, wanted);
    warn_of_mended(plan);
    return dry_run(arguments, dataset.recipe, plan, build_options);
  }
  DatasetRequest request = arguments.request();
  request.check_filled = [](const SlurmMark& mark) {
    refuse_filled_store(mark, "a build without --database");
  };
  Dataset dataset = open_dataset(request, Access::build, disk);
  check_local(*dataset.store);
  const bool read_only = is_read_only(dataset.store->folder());
  const std::optional<Guest> guest = read_only ? std::nullopt : enter_as_guest(arguments, dataset);
  // Jobs of Slurm have a mark for all of theirs.
  if (request.in_passing && !read_only && !find_slurm_mark(*dataset.store)) note_parts(dataset);
  const auto waits_for = [&](const std::string& who) {
    say(Stream::people, "dsbuild: {}: waiting for another build that makes something else: {}\n",
        dataset.folder.string(), who);
  };
  const SolePlan sole =
      make_sole_plan(dataset, stamps_of(arguments), arguments.force, shard, wanted, waits_for);
  Inputs& inputs = *sole.inputs;
  const Plan& plan = sole.plan;
  check_can_keep(*dataset.store, plan);
  warn_of_mended(plan);
  if (const std::string edited = edited_text(plan); !edited.empty()) warn(edited);
  const std::vector<Lacking> all_lacking = find_lacking(plan, inputs);
  for (const Lacking& lacking : all_lacking)
    warn(to_text(lacking));
  if (arguments.explain)
    print_plan(arguments.json ? Stream::people : Stream::report, plan, arguments.verbose);

  const RendererFactory factory = [&] {
    TracerOptions options;
    options.device = arguments.device;
    std::unique_ptr<Renderer> renderer = make_tracer_renderer(inputs, dataset.recipe, options);
    tell_device(renderer->device());
    return renderer;
  };
  BuildResult result;
  std::set<std::string> told_before;
  const BroughtHome brought = work_and_bring_home(*dataset.store, disk, [&] {
    // Only now: planning may be ended anywhere, and needs nobody to wait for it.
    const std::atomic<bool>& stop = stop_on_signal();
    Progress progress(arguments.keep_going, earlier);
    WatchedObserver watched(progress);
    result = execute(dataset, plan, inputs, build_options, disk, factory, watched, stop);
    told_before = progress.told();
  });
  if (!brought.failed.empty()) result.failures.emplace_back("the store", brought.failed);
  for (const auto& [what, why] : result.failures)
    if (!told_before.contains(what)) say(Stream::people, "dsbuild: error: {}: {}\n", what, why);
  if (result.stopped)
    say(Stream::people, "dsbuild: stopped; what is finished is recorded, build again to go on\n");
  const bool is_whole = arguments.shard.empty() && !arguments.no_files;
  if (is_whole && !read_only) {
    if (!arguments.database_folder.empty() && !result.disk_failed)
      put_database(*dataset.store, *dataset.database, arguments.database_folder, disk);
    if (arguments.database_folder.empty() && result.ok()) remove_mark(dataset);
    if (result.ok()) forget_parts(dataset);
  }
  const std::size_t concerns = tell_concerns(result.concerns, dataset.recipe, arguments.strict);
  // Where it was stopped, what stands there of an earlier build was looked at.
  if (const std::uint64_t others = result.failed + result.not_reached;
      others > 0 && !result.stopped)
    say(Stream::people, "not looked at: {} of {} images, which this build did not make\n", others,
        result.images);
  nlohmann::json told = to_json(result, dataset);
  told["lacking"] = to_json(all_lacking);
  told["edited_files"] = plan.edited.size();
  told["strict_errors"] = concerns;
  told["uneven"] = tell_uneven(dataset.recipe, plan);
  if (brought.result) told["gathered"] = to_json(*brought.result);
  if (arguments.json)
    print_json(told);
  else
    print_result(result, dataset);
  const int code = result.ok() && concerns == 0 ? 0 : 1;
  // Who reads the report is to have one, whatever becomes of this process at its end.
  if (!stopped_by_signal()) tell_end_of_build(lost_result() ? 1 : code);
  return code;
}

}  // namespace ds

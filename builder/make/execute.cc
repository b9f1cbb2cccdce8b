// SPDX-License-Identifier: Apache-2.0
#include "builder/make/execute.h"

#include "builder/make/left_over.h"
#include "builder/make/manifest_lines.h"
#include "builder/plan/dataset_manifest.h"
#include "builder/plan/manifest_state.h"
#include "builder/plan/placed_files.h"
#include "builder/store/build_ending.h"
#include "builder/store/host.h"
#include "builder/store/killed_builds.h"
#include "tracer/base/disk_error.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <tuple>
#include <unistd.h>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// How long to sleep where every image left is being made by other processes.
constexpr std::chrono::milliseconds k_claim_poll{50};

/// The first image of each kind that can need a program of its own: the effects of its scene
/// depend on material and environment, not on the model.
std::vector<const ImageSpec*> one_of_each_kind(const std::deque<const PlannedImage*>& queue) {
  std::set<std::tuple<fs::path, fs::path, bool, MathMode>> kinds;
  std::vector<const ImageSpec*> first;
  for (const PlannedImage* image : queue) {
    const ImageSpec& spec = image->spec;
    if (image->traces_paths() && kinds
                                     .emplace(spec.material_file, spec.environment_folder,
                                              spec.camera.lens_radius_m > 0, spec.engine.math)
                                     .second)
      first.push_back(&spec);
  }
  return first;
}

/// What images of one scene have in common.
auto scene_of(const ImageSpec& spec) {
  return std::tie(spec.model_file, spec.material_file, spec.environment_folder);
}

class Execution {
 public:
  Execution(Dataset& dataset, const Plan& plan, Inputs& inputs, const BuildOptions& options,
            Disk& disk, const RendererFactory& factory, BuildObserver& observer,
            const std::atomic<bool>& stop)
      : dataset_(dataset),
        plan_(plan),
        options_(options),
        disk_(disk),
        observer_(observer),
        stop_(stop),
        maker_(dataset, inputs, plan.texts, disk, factory,
               options.wanted == Wanted::store
                   ? std::nullopt
                   : std::optional(options.copy ? Placing::copy : Placing::share)) {
    maker_.keeper().enter_in(options.earlier.journal);
  }

  BuildResult run();

 private:
  using Queue = std::deque<const PlannedImage*>;

  void enter_dataset();
  Queue sort_images();
  bool made_before(const PlannedImage& image);
  void count(const PlannedImage& image, const ImageWork& work);
  bool is_suspect(const PlannedImage& image) const {  // it is made with nothing beside it
    return options_.earlier.crash_of(image.spec.id) != nullptr;
  }
  void make_all(Queue queue);
  void expect_next_scene(const Queue& queue, const PlannedImage& image);
  bool make_one(const PlannedImage& image);
  void take_kept();
  void catch_failure(const PlannedImage& image, const std::function<void()>& work);
  void fail_image(const PlannedImage& image, const std::string& why);
  void collect_failures();
  bool is_as_planned() const;
  bool is_in_place(PlacedFiles& placed, const PlannedImage& image);
  ListedImages look_at_images(PlacedFiles& placed, bool as_planned);
  void find_capped(const ListedImages& images);
  bool take_standing_manifest(const ListedImages& images, const ManifestSources& sources,
                              const PlacedFiles& placed);
  void write_manifest(const ListedImages& images, ManifestSources sources, PlacedFiles& placed);
  bool anything_to_do() const;
  void begin();
  void finish();
  void remove_left();
  const char* outcome() const;
  void log();
  /// Whether no further image is made.
  bool cut_short() const {
    return stop_ || result_.disk_failed || (result_.failed > 0 && !options_.keep_going);
  }

  Dataset& dataset_;
  const Plan& plan_;
  BuildOptions options_;
  Disk& disk_;
  BuildObserver& observer_;
  const std::atomic<bool>& stop_;
  ImageMaker maker_;
  BuildResult result_;
  std::unordered_set<const PlannedImage*> made_;  ///< by this build
  const PlannedImage* last_started_ = nullptr;    ///< the first of its scene
  /// Of images under way, until they are kept: another process would make them too.
  std::unordered_map<const PlannedImage*, Claims::Claim> claims_;
  std::map<std::string, std::vector<std::string>> failures_;  ///< image ids by what went wrong
  std::string no_device_;                                     ///< why nothing can be traced
  std::int64_t build_number_ = 0;
};

void Execution::fail_image(const PlannedImage& image, const std::string& why) {
  ++result_.failed;
  failures_[why].push_back(image.spec.id);
  observer_.image_failed(image, why);
}

/// With the recipe and overrides that are built now.
void Execution::enter_dataset() {
  const Claims::Claim claim = dataset_.claims->own_datasets();
  const auto row = dataset_.database->find_dataset(dataset_.row.id);
  if (row) dataset_.row.manifest = row->manifest;
  if (row != dataset_.row) dataset_.database->put_dataset(dataset_.row);
}

/// Whether files, or what the database has of images, may come to be others.
bool Execution::anything_to_do() const {
  return options_.copy || !plan_.to_remove.empty() || plan_.forgets || !plan_.manifest.current() ||
         std::any_of(plan_.images.begin(), plan_.images.end(),
                     [](const PlannedImage& image) { return image.stale() || image.record; });
}

/// Enters the build before it writes any file, so that another one sees where this one is killed.
void Execution::begin() {
  if (build_number_ != 0) return;
  build_number_ = dataset_.database->begin_build(dataset_.row.id, host_name(), ::getpid());
  make_room_for_ending(dataset_.folder);
}

/// Enters what was made now.
void Execution::count(const PlannedImage& image, const ImageWork& work) {
  ++result_.built;
  made_.insert(&image);
  result_.traced += work.traced ? 1U : 0U;
  result_.developed += work.developed ? 1U : 0U;
  result_.traced_samples += work.samples;
}

/// Whether a process of this build that died made all of the image, which is counted then: it is
/// built, not reused, and not made again with `force`.
bool Execution::made_before(const PlannedImage& image) {
  const MadeImage* made = options_.earlier.made_of(image.spec.id);
  if (made == nullptr || (image.stale() && !(options_.force && made->placed))) return false;
  count(image, made->work);
  return true;
}

/// Counts the shard's images and those that need nothing, enters failures, and returns what is to
/// be made, images of one scene together.
Execution::Queue Execution::sort_images() {
  Queue queue;
  for (const PlannedImage& image : plan_.images) {
    if (image.elsewhere) continue;
    ++result_.images;
    if (image.error) {
      fail_image(image, image.error->what());
    } else if (const CrashedImage* crash = options_.earlier.crash_of(image.spec.id);
               crash != nullptr && crash->times >= k_most_crashes) {
      // Told by who saw it.
      failures_[to_text(*crash)].push_back(image.spec.id);
      ++result_.failed;
    } else if (const bool before = made_before(image); image.stale() && !before) {
      if (options_.copy) maker_.keeper().part_from_store(image);
      queue.push_back(&image);
    } else {
      if (!before) ++result_.reused;
      if (image.record) maker_.keeper().record(image);
      if (options_.copy) maker_.keeper().part_from_store(image);
    }
  }
  std::stable_sort(queue.begin(), queue.end(), [](const PlannedImage* a, const PlannedImage* b) {
    return scene_of(a->spec) < scene_of(b->spec);
  });
  std::stable_partition(queue.begin(), queue.end(),
                        [this](const PlannedImage* image) { return is_suspect(*image); });
  return queue;
}

/// Looks on from the first image of a scene, once, to the next scene of which anything is traced.
void Execution::expect_next_scene(const Queue& queue, const PlannedImage& image) {
  if (is_suspect(image)) return;
  if (last_started_ != nullptr && scene_of(last_started_->spec) == scene_of(image.spec)) return;
  last_started_ = &image;
  const auto next = std::find_if(queue.begin(), queue.end(), [&](const PlannedImage* other) {
    return (other->traces_paths() || other->trace_planes) &&
           scene_of(other->spec) != scene_of(image.spec);
  });
  if (next != queue.end()) maker_.expect(**next);
}

/// Enters what stops one image.
void Execution::catch_failure(const PlannedImage& image, const std::function<void()>& work) {
  try {
    work();
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const DiskFailed& error) {
    // What it refuses one image it refuses the rest: tracing them would be for nothing.
    result_.disk_failed = true;
    fail_image(image, error.what());
  } catch (
      const NoDevice& error) {  // said of the build, not of the image that happened to be first
    ++result_.failed;
    no_device_ = error.what();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::cancelled) fail_image(image, error.what());
  }
}

/// False where another process is making the image now.
bool Execution::make_one(const PlannedImage& image) {
  auto claim = dataset_.claims->try_image(image.keys.render);
  if (!claim) return false;
  observer_.image_started(image);
  catch_failure(image, [&] {
    maker_.start(
        image, options_.force,
        [&](const TraceProgress& progress) { observer_.progress(image, progress); }, stop_);
    claims_.emplace(&image, *std::move(claim));
  });
  return true;
}

/// Counts the images whose files are in place by now.
void Execution::take_kept() {
  for (const KeptImage& kept : maker_.keeper().take()) {
    claims_.erase(kept.image);
    if (kept.dropped) continue;
    catch_failure(*kept.image, [&] {
      if (kept.error) std::rethrow_exception(kept.error);
      const MadeImage* before = options_.earlier.made_of(kept.image->spec.id);
      count(*kept.image, before != nullptr ? together(before->work, kept.work) : kept.work);
      observer_.image_done(*kept.image, kept.work);
    });
  }
}

void Execution::make_all(Queue queue) {
  std::uint64_t samples = 0;
  for (const PlannedImage* image : queue)
    samples += image->traces_paths() ? image->samples() : 0;
  observer_.started(queue.size(), samples);
  if (options_.earlier.deaths == 0) maker_.announce(one_of_each_kind(queue));
  std::size_t put_back = 0;  // images in a row that others are making
  while (!queue.empty() && !cut_short()) {
    const PlannedImage* image = queue.front();
    queue.pop_front();
    expect_next_scene(queue, *image);
    const bool started = make_one(*image);
    if (is_suspect(*image)) maker_.keeper().finish();
    take_kept();
    if (started) {
      put_back = 0;
      continue;
    }
    queue.push_back(image);
    if (++put_back < queue.size()) continue;
    observer_.waiting();
    std::this_thread::sleep_for(k_claim_poll);
  }
  maker_.keeper().finish();
  take_kept();
  observer_.all_tried();
  result_.stopped = stop_ && !queue.empty();
}

void Execution::collect_failures() {
  if (!no_device_.empty()) result_.failures.emplace_back("tracing", no_device_);
  for (const auto& [why, ids] : failures_) {
    const std::string what =
        ids.size() == 1 ? ids.front() : fmt::format("{} images, {} ...", ids.size(), ids.front());
    result_.failures.emplace_back(what, why);
  }
}

void Execution::remove_left() {
  RemovedFiles removed = remove_left_over(dataset_, plan_, disk_);
  result_.removed_files = removed.files;
  std::move(removed.failures.begin(), removed.failures.end(), std::back_inserter(result_.failures));
}

/// Whether all files of the image are as they were placed; not where that cannot be told.
bool Execution::is_in_place(PlacedFiles& placed, const PlannedImage& image) {
  try {
    return placed.all_in_place(image);
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const DiskFailed&) {
    throw;
  } catch (const Error& error) {
    result_.failures.emplace_back(image.spec.id, error.what());
    return false;
  }
}

/// Whether this build changed nothing, and nobody else did since it was planned: then what the plan
/// found in place is not looked at twice. With `copy` files may have been parted from the store,
/// which changes their stamps.
bool Execution::is_as_planned() const {
  return result_.built == 0 && !options_.copy && plan_.to_remove.empty() && !plan_.forgets &&
         plan_.data_version == dataset_.database->data_version() &&
         std::none_of(plan_.images.begin(), plan_.images.end(),
                      [](const PlannedImage& image) { return image.stale() || image.record; });
}

/// Tells apart the images whose files are in place. `as_planned`: those of other shards only are
/// looked at.
ListedImages Execution::look_at_images(PlacedFiles& placed, bool as_planned) {
  ListedImages images;
  for (const PlannedImage& image : plan_.images) {
    const bool known = as_planned && !image.elsewhere;
    const bool made = !image.error && (known || is_in_place(placed, image));
    (made ? images.made : images.lacking).push_back(&image);
    if (!made && !image.error && (image.elsewhere || cut_short())) images.pending.push_back(&image);
  }
  return images;
}

/// The pictures of the shard that are less exact than the recipe wants.
void Execution::find_capped(const ListedImages& images) {
  if (!dataset_.recipe.engine.target) return;
  auto capped = dataset_.database->capped_pictures();
  std::sort(capped.begin(), capped.end());
  for (const PlannedImage* image : images.made) {
    if (image->elsewhere) continue;
    for (const OutputFile& output : image->keys.outputs) {
      const auto found =
          std::lower_bound(capped.begin(), capped.end(), std::pair(output.key, -1.0));
      if (output.kind == "image" && found != capped.end() && found->first == output.key)
        result_.capped.emplace_back(image->spec.id, found->second);
    }
  }
}

/// Whether the manifest that stands is the one this build would write; then also what it says.
bool Execution::take_standing_manifest(const ListedImages& images, const ManifestSources& sources,
                                       const PlacedFiles& placed) {
  if (result_.built > 0 || !manifest_stands(dataset_, sources, placed)) return false;
  result_.concerns = read_dataset_manifest(dataset_.folder).concerns;
  find_capped(images);
  return true;
}

void Execution::finish() {
  if (options_.wanted == Wanted::store) {
    ListedImages all;
    for (const PlannedImage& image : plan_.images)
      if (!image.error) all.made.push_back(&image);
    return find_capped(all);
  }
  if (is_as_planned() && plan_.manifest.current()) {
    const ListedImages images = look_at_images(*plan_.placed, true);
    auto sources = sources_as_planned(plan_);
    if (!sources) sources = manifest_sources(plan_, images, *plan_.placed);
    if (take_standing_manifest(images, *sources, *plan_.placed)) return;
  }
  begin();
  maker_.keeper().remember_stamps();
  // Of builds that end at once, the last to write must have seen what all of them placed.
  const Claims::Claim claim = dataset_.claims->own_datasets();
  if (!cut_short()) remove_left();
  const bool as_planned = is_as_planned();
  std::optional<PlacedFiles> placed_now;
  PlacedFiles& placed = as_planned ? *plan_.placed : placed_now.emplace(dataset_);
  const ListedImages images = look_at_images(placed, as_planned);
  const ManifestSources sources = manifest_sources(plan_, images, placed);
  if (!take_standing_manifest(images, sources, placed)) write_manifest(images, sources, placed);
}

void Execution::write_manifest(const ListedImages& images, ManifestSources sources,
                               PlacedFiles& placed) {
  const auto is_new = [this](const PlannedImage& image) { return made_.contains(&image); };
  const WrittenManifest written =
      ds::write_manifest(dataset_, plan_, placed,
                         {images, is_new, cut_short(), lines_hold(dataset_, sources, placed)});
  result_.concerns = written.concerns;
  find_capped(images);
  if (written.left_over) sources.listing = {};  // so that it does not stand
  remember_manifest(dataset_, sources);
}

const char* Execution::outcome() const {
  if (result_.disk_failed) return k_disk_failed;
  if (result_.stopped) return "stopped";
  return result_.failures.empty() ? "done" : "failed";
}

void Execution::log() {
  result_.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - options_.started).count();
  BuildRow row{0,
               "",
               "",
               ::getpid(),
               result_.device,
               outcome(),
               result_.images,
               result_.built,
               result_.reused,
               result_.failed,
               result_.traced_samples,
               result_.seconds};
  try {
    Transaction transaction(dataset_.database->connection());
    begin();
    row.number = build_number_;
    dataset_.database->update_build(row);
    transaction.commit();
  } catch (const DiskFailed& error) {
    if (!result_.disk_failed) result_.failures.emplace_back("the log", error.what());
    result_.disk_failed = true;
    row.outcome = k_disk_failed;
    keep_ending(dataset_.folder, row);
  }
}

BuildResult Execution::run() {
  enter_dataset();
  if (anything_to_do()) begin();
  clean_up_killed_builds(dataset_, build_number_);
  make_all(sort_images());
  collect_failures();
  result_.not_reached = result_.images - result_.built - result_.reused - result_.failed;
  result_.deaths = options_.earlier.deaths;
  result_.device = maker_.device();
  if (result_.device.empty()) result_.device = options_.earlier.device;
  result_.programs = maker_.programs();
  // The images made are recorded; the caller is to learn their counts too.
  try {
    finish();
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const DiskFailed& error) {
    result_.disk_failed = true;
    result_.failures.emplace_back("the manifest", error.what());
  } catch (const Error& error) {
    result_.failures.emplace_back("the manifest", error.what());
  }
  log();
  return result_;
}

}  // namespace

BuildResult execute(Dataset& dataset, const Plan& plan, Inputs& inputs, const BuildOptions& options,
                    Disk& disk, const RendererFactory& factory, BuildObserver& observer,
                    const std::atomic<bool>& stop) {
  return Execution(dataset, plan, inputs, options, disk, factory, observer, stop).run();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/earlier_processes.h"
#include "builder/make/image_maker.h"
#include "manifests/concerns.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ds {

struct BuildOptions {
  bool keep_going = false;  ///< make the images that can be made where others fail
  bool force = false;       ///< trace every image again
  bool copy = false;        ///< no file shares anything with the store
  /// Of which the plan must be, too. Where files are not wanted, what is counted as built went into
  /// the store, and the folder and the manifest stay as they are.
  Wanted wanted = Wanted::files;
  /// Where some died, what they died at comes first, with nothing done beside it, so that it is known
  /// which one it is if one dies again. What they made is counted as made, and not made again.
  EarlierProcesses earlier = {};
  /// When what the user started began; BuildResult::seconds counts from here.
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
};

/// Counts are of the shard's images; images = built + reused + failed + not_reached.
struct BuildResult {
  std::uint64_t images = 0;
  std::uint64_t built = 0;   ///< at least one file was put into the folder
  std::uint64_t reused = 0;  ///< every file was there
  std::uint64_t failed = 0;
  std::uint64_t not_reached = 0;     ///< stopped before, by the user or by another's failure
  std::uint64_t removed_files = 0;   ///< of the shard's images that the recipe has no more
  std::uint64_t traced = 0;          ///< of the built: something was traced
  std::uint64_t developed = 0;       ///< of the built: a picture was made from a film
  std::uint64_t traced_samples = 0;  ///< camera samples, over all pixels
  std::uint64_t deaths = 0;          ///< processes that died on the way
  ProgramCounts programs;            ///< of the last process
  double seconds = 0;                ///< of all of it, planning and processes that died, too
  std::string device;                ///< empty where nothing was traced
  bool stopped = false;              ///< by the user
  bool disk_failed = false;          ///< the disk took nothing more: full, read only or broken
  /// What ("human.ply/0", "14 images, ..."), why.
  std::vector<std::pair<std::string, std::string>> failures;
  std::vector<Concern> concerns;  ///< of all images that the manifest lists

  /// Images that max_spp ended before engine.error was reached, and the upper end of their error.
  std::vector<std::pair<std::string, double>> capped;

  bool ok() const { return !stopped && failures.empty(); }
};

/// Told what goes on, from the thread that called `execute`.
class BuildObserver {
 public:
  virtual ~BuildObserver() = default;
  /// `images` to make, `samples` to trace for them.
  virtual void started(std::uint64_t /*images*/, std::uint64_t /*samples*/) {}
  virtual void image_started(const PlannedImage& /*image*/) {}
  virtual void progress(const PlannedImage& /*image*/, const TraceProgress& /*progress*/) {}
  virtual void image_done(const PlannedImage& /*image*/, const ImageWork& /*work*/) {}
  virtual void image_failed(const PlannedImage& /*image*/, const std::string& /*why*/) {}
  /// Every image left is being made by other processes.
  virtual void waiting() {}
  /// No image is under way, and none will be: what follows is the manifest.
  virtual void all_tried() {}
};

/// Makes what the plan found stale: images of one scene one after another, so that a scene is
/// uploaded once. An image another process is making now is left for last and then found in the
/// store. Ends early when `stop` is set: what is finished is recorded, the image under way is not.
/// Afterwards the manifest lists exactly the images whose files are in place, whichever build put
/// them there: an image that could not be made, or was not reached, as the build before made it.
/// What the plan was to remove is removed where the build was not cut short, and else stays listed.
/// Throws only for what concerns the dataset as a whole.
BuildResult execute(Dataset& dataset, const Plan& plan, Inputs& inputs, const BuildOptions& options,
                    Disk& disk, const RendererFactory& factory, BuildObserver& observer,
                    const std::atomic<bool>& stop);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/execute.h"

#include <optional>

namespace ds {

/// Splits `dsbuild build` in two: a process that builds, and this one, which watches it and begins
/// another where it dies of what no error can be made of (a driver's crash, an abort, the system
/// short of memory) or shows no sign of life. What is made is made: the next process goes on, and
/// is told during which image it happened; outside of images it is begun again once. Where nothing
/// is left to try, that is one error, and with `json` what is known of the build, too. Called before anything
/// else of the process begins.
///
/// Signs of life are an image begun, ended or a step of its samples further, and a look at what
/// other builds make; before the first image and behind the last also any time of the processor
/// that it uses.
///
/// Nothing: this is the process that builds (or nobody watches it, where the system gives no second
/// process). Else the exit code; signals that end the one end the other likewise.
std::optional<int> watch_over_build(bool json);

/// In the process that builds: what earlier ones came to. Empty where nobody watches.
EarlierProcesses earlier_processes();
/// What `--stall` takes at least: within an image, programs are compiled and models read without a
/// sign of life.
inline constexpr double k_least_stall_seconds = 5;
/// In the process that builds: seconds without a sign of life after which it is taken to hang; 0: never.
/// Before this is told it is the default of `--stall`. Throws Error(usage) for less than the least.
void expect_signs_of_life(double hang_seconds);
/// In the process that builds: what it traces on.
void tell_device(const std::string& device);
/// In the process that builds: that it has told all it has to tell, and its exit code, which stands
/// whatever becomes of the process then.
void tell_end_of_build(int code);

/// Tells the watching process what goes on, and passes it on.
class WatchedObserver : public BuildObserver {
 public:
  explicit WatchedObserver(BuildObserver& observer);
  ~WatchedObserver() override;

  void started(std::uint64_t images, std::uint64_t samples) override;
  void image_started(const PlannedImage& image) override;
  void progress(const PlannedImage& image, const TraceProgress& progress) override;
  void image_done(const PlannedImage& image, const ImageWork& work) override;
  void image_failed(const PlannedImage& image, const std::string& why) override;
  void waiting() override;
  void all_tried() override;

 private:
  BuildObserver& observer_;
};

}  // namespace ds

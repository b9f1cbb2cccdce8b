// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/execute.h"

#include <chrono>
#include <cstdint>
#include <set>
#include <string>

namespace ds {

/// Shows a build's progress on standard error: one line that moves on a terminal and fits it, one
/// line an image elsewhere.
class Progress : public BuildObserver {
 public:
  /// `tell_failures`: the first of each cause as it comes; else they are left to the end, which is then
  /// near. What processes before this one came to is done already.
  explicit Progress(bool tell_failures, const EarlierProcesses& earlier = {});
  ~Progress() override;

  void started(std::uint64_t images, std::uint64_t samples) override;
  void image_started(const PlannedImage& image) override;
  void progress(const PlannedImage& image, const TraceProgress& progress) override;
  void image_done(const PlannedImage& image, const ImageWork& work) override;
  void image_failed(const PlannedImage& image, const std::string& why) override;

  /// Ids of the images whose failure was told as it came.
  const std::set<std::string>& told() const { return told_; }

 private:
  /// Of what takes the time: samples where any are traced, else images.
  double total() const { return static_cast<double>(samples_ > 0 ? samples_ : images_); }
  double done(std::uint64_t samples_now) const {
    return static_cast<double>(samples_ > 0 ? samples_done_ + samples_now : images_done_);
  }
  std::string line(const std::string& image, std::uint64_t samples_now) const;
  void show(const std::string& image, std::uint64_t samples_now);

  using Clock = std::chrono::steady_clock;
  bool tell_failures_;
  std::set<std::string> causes_, told_;
  bool moves_;
  std::uint64_t images_before_,
      samples_before_;  ///< to make and to trace, when the first process began
  std::uint64_t images_ = 0, images_done_ = 0;
  std::uint64_t samples_ = 0;         ///< planned
  std::uint64_t samples_done_ = 0;    ///< of those, by finished images
  std::uint64_t samples_traced_ = 0;  ///< really traced by finished images
  double done_at_start_ = 0;          ///< of samples_ or images_, by earlier processes
  Clock::time_point start_ = Clock::now();
};

/// "512 samples", "8.2 ksamples", "1835.0 Msamples".
std::string format_samples(std::uint64_t samples);
/// "0:07", "12:34", "3:25:45".
std::string format_duration(double seconds);

}  // namespace ds

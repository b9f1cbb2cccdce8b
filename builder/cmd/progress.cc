// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/progress.h"

#include "tracer/base/error.h"
#include "tracer/base/streams.h"
#include "tracer/base/text_width.h"

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

/// Of an image's name, however narrow the terminal is.
constexpr int k_least_name_columns = 8;

}  // namespace

std::string format_samples(std::uint64_t samples) {
  const auto count = static_cast<double>(samples);
  // What would round to 1000.0 k is a million.
  if (count >= 999'950) return fmt::format("{:.1f} Msamples", count * 1e-6);
  if (count >= 1000) return fmt::format("{:.1f} ksamples", count * 1e-3);
  return fmt::format("{} samples", samples);
}

std::string format_duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  const std::uint64_t hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02}", minutes, whole % 60);
}

Progress::Progress(bool tell_failures, const EarlierProcesses& earlier)
    : tell_failures_(tell_failures),
      moves_(has_status_line()),
      images_before_(earlier.to_make),
      samples_before_(earlier.samples_to_trace) {}

Progress::~Progress() {
  clear_status_line();
}

void Progress::started(std::uint64_t images, std::uint64_t samples) {
  images_ = std::max(images, images_before_);
  images_done_ = images_ - images;
  samples_ = std::max(samples, samples_before_);
  samples_done_ = samples_ - samples;
  done_at_start_ = done(0);
  start_ = Clock::now();
}

std::string Progress::line(const std::string& image, std::uint64_t samples_now) const {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double traced = static_cast<double>(samples_traced_ + samples_now);
  const double share = total() > 0 ? done(samples_now) / total() : 1;
  const double done_here = done(samples_now) - done_at_start_;
  // Rounded down: 100 % is all of it.
  const std::string before =
      fmt::format("[{}/{}] {:3.0f}% ", images_done_, images_, std::floor(100 * share));
  std::string rate, left;
  if (traced > 0 && seconds > 0) rate = fmt::format("  {:.2f} Msamples/s", traced / seconds * 1e-6);
  if (done_here > 0 && share < 1)
    left = "  ETA " + format_duration(seconds * (total() - done(samples_now)) / done_here);
  const std::optional<int> columns = line_columns();
  if (!columns) return before + image + rate + left;
  // What is too long for the terminal is the name, then the rate: when it ends is what people watch.
  const auto room = [&] { return *columns - columns_of(before) - columns_of(rate + left); };
  if (room() < k_least_name_columns) rate.clear();
  const std::string behind = rate + left;
  const int for_name = room();
  return cut_to_columns(
      before + shorten_to_columns(image, std::max(for_name, k_least_name_columns)) + behind,
      *columns);
}

void Progress::show(const std::string& image, std::uint64_t samples_now) {
  if (moves_) show_status_line(line(image, samples_now));
}

void Progress::image_started(const PlannedImage& image) {
  show(image.spec.id, 0);
}

void Progress::progress(const PlannedImage& image, const TraceProgress& progress) {
  show(image.spec.id, progress.samples_done);
}

void Progress::image_done(const PlannedImage& image, const ImageWork& work) {
  ++images_done_;
  samples_done_ += image.traces_paths() ? image.samples() : 0;
  samples_traced_ += work.samples;
  if (moves_)
    show(image.spec.id, 0);
  else
    say(Stream::people, "{}\n", line(image.spec.id, 0));
}

void Progress::image_failed(const PlannedImage& image, const std::string& why) {
  // One that could not even be planned is told at the end, with the others its file fails.
  if (image.error) return;
  ++images_done_;
  samples_done_ += image.traces_paths() ? image.samples() : 0;
  // Others of the same cause are counted at the end.
  if (!tell_failures_ || !causes_.insert(why).second) return;
  told_.insert(image.spec.id);
  say(Stream::people, "dsbuild: error: {}: {}\n", image.spec.id, why);
}

}  // namespace ds

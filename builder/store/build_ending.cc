// SPDX-License-Identifier: Apache-2.0
#include "builder/store/build_ending.h"

#include "builder/store/killed_builds.h"
#include "tracer/base/regular_file.h"

#include <fcntl.h>
#include <optional>
#include <string>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// `.dsbuild/ending`, filled up with spaces to its size, a line each:
///   "dsbuild ending 1"
///   number of the build in the log, number of its process
///   outcome
///   device
///   images, built, reused, failed, traced samples, seconds
constexpr const char* k_file = "ending";
constexpr const char* k_header = "dsbuild ending 1";
constexpr std::size_t k_size = 512;

/// Of the file's size; a device of an odd length is left out.
std::string text_of(const BuildRow& build) {
  const auto with_device = [&](const std::string& device) {
    return fmt::format("{}\n{} {}\n{}\n{}\n{} {} {} {} {} {}\n", k_header, build.number,
                       build.process, build.outcome, device, build.images, build.built,
                       build.reused, build.failed, build.traced_samples, build.seconds);
  };
  std::string text = with_device(build.device);
  if (text.size() > k_size) text = with_device("");
  text.resize(k_size, ' ');
  return text;
}

void write_over(const fs::path& file, const std::string& text, int flags) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | flags, 0666);
  if (descriptor < 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, text.data(), text.size(), 0);
  ::close(descriptor);
}

std::optional<BuildRow> kept_ending(const fs::path& folder, const BuildRow& build) {
  std::ifstream file = regular_stream(folder / ".dsbuild" / k_file);
  std::string header, rest;
  BuildRow kept = build;
  std::getline(file, header);
  file >> kept.number >> kept.process;
  std::getline(file, rest);
  std::getline(file, kept.outcome);
  std::getline(file, kept.device);
  file >> kept.images >> kept.built >> kept.reused >> kept.failed >> kept.traced_samples >>
      kept.seconds;
  if (!file || header != k_header || kept.number != build.number || kept.process != build.process)
    return std::nullopt;
  return kept;
}

}  // namespace

void make_room_for_ending(const fs::path& folder) {
  const fs::path file = folder / ".dsbuild" / k_file;
  std::error_code error;
  // What it says of a build that no other has entered in the log yet stays.
  if (fs::file_size(file, error) == k_size && !error) return;
  write_over(file, std::string(k_size, ' '), O_CREAT);
}

void keep_ending(const fs::path& folder, const BuildRow& build) {
  write_over(folder / ".dsbuild" / k_file, text_of(build), 0);
}

BuildRow as_ended(const Dataset& dataset, BuildRow build) {
  if (!was_killed(build)) return build;
  if (const auto kept = kept_ending(dataset.folder, build)) return *kept;
  build.outcome = "killed";
  return build;
}

}  // namespace ds

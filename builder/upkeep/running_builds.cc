// SPDX-License-Identifier: Apache-2.0
#include "builder/upkeep/running_builds.h"

#include "builder/db/named_products.h"
#include "builder/store/guest.h"
#include "builder/store/killed_builds.h"

#include <chrono>

namespace ds {
namespace {

/// Clocks of machines that share a disk, and a log that knows seconds.
constexpr std::chrono::seconds k_clocks{2};

std::filesystem::file_time_type file_time(std::int64_t unix_seconds) {
  const std::chrono::sys_seconds time{std::chrono::seconds(unix_seconds)};
  return std::chrono::time_point_cast<std::filesystem::file_time_type::duration>(
      std::chrono::file_clock::from_sys(time));
}

}  // namespace

std::vector<RunningBuild> running_builds(const Store& store, Database& database) {
  std::vector<RunningBuild> running;
  visit_running_builds(
      database, [&](const std::string& name, const BuildRow& build, std::int64_t unix_seconds) {
        if (!was_killed(build))
          running.push_back(
              {fmt::format("process {} on {}, which builds {}", build.process, build.host, name),
               file_time(unix_seconds) - k_clocks});
      });
  for (const Guest::Builder& guest : Guest::builders(store))
    running.push_back(
        {fmt::format("{}, which has its database elsewhere ({})", guest.who, guest.what),
         guest.since - k_clocks});
  return running;
}

}  // namespace ds

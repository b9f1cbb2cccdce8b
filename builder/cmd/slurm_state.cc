// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/slurm_state.h"

#include "builder/cmd/run_program.h"
#include "builder/store/host.h"
#include "tracer/base/error.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>

namespace ds {
namespace {

/// Longer than jobs are being submitted: whoever began that has died.
constexpr std::chrono::minutes k_longest_submission{10};

SlurmState state_of_submission(const SlurmMark& mark) {
  if (mark.host == host_name() && ::kill(static_cast<pid_t>(mark.process), 0) != 0 &&
      errno == ESRCH)
    return SlurmState::gone;
  std::error_code error;
  const auto written = std::filesystem::last_write_time(mark.file, error);
  const bool old =
      !error && std::filesystem::file_time_type::clock::now() - written > k_longest_submission;
  return old ? SlurmState::gone : SlurmState::running;
}

SlurmState state_of_job(const std::string& id) {
  const ProgramAnswer answer =
      run_program({"squeue", "--noheader", "--jobs", id, "--format", "%T"}, true);
  if (answer.code == 0) return answer.said.empty() ? SlurmState::gone : SlurmState::running;
  // What Slurm says of a job that ended long ago.
  return answer.said.find("Invalid job id") != answer.said.npos ? SlurmState::gone
                                                                : SlurmState::unknown;
}

constexpr const char* name_of(SlurmState state) {
  return state == SlurmState::running ? "running" : state == SlurmState::gone ? "gone" : "unknown";
}

}  // namespace

SlurmState state_of(const SlurmMark& mark) {
  if (mark.jobs.empty()) return state_of_submission(mark);
  if (!find_program("squeue")) return SlurmState::unknown;
  SlurmState all = SlurmState::gone;
  for (const std::string& id : mark.jobs) {
    const SlurmState one = state_of_job(id);
    if (one == SlurmState::running) return one;
    if (one == SlurmState::unknown) all = one;
  }
  return all;
}

std::string jobs_text(const SlurmMark& mark) {
  const std::string jobs = mark.jobs.empty() ? "jobs that are being submitted"
                                             : fmt::format("jobs {}", fmt::join(mark.jobs, ", "));
  return fmt::format("{} of {}, submitted on {} at {} UTC, in {} shares", jobs, mark.user,
                     mark.host, mark.since, mark.shards);
}

std::string to_text(const SlurmMark& mark) {
  switch (state_of(mark)) {
    case SlurmState::running:
      return jobs_text(mark) + ", make it now";
    case SlurmState::gone:
      return jobs_text(mark) + ", ended before it was whole (dsbuild slurm goes on)";
    case SlurmState::unknown:
      break;
  }
  return jobs_text(mark) + ", and squeue does not say here whether they still are";
}

nlohmann::json to_json(const SlurmMark& mark) {
  return {{"jobs", mark.jobs},
          {"shards", mark.shards},
          {"recipe", mark.recipe.string()},
          {"since", mark.since},
          {"user", mark.user},
          {"host", mark.host},
          {"state", name_of(state_of(mark))}};
}

void refuse_filled_store(const SlurmMark& mark, std::string_view what) {
  const SlurmState state = state_of(mark);
  if (state == SlurmState::gone) return;
  const std::string store = mark.file.parent_path().parent_path().string();
  if (state == SlurmState::running)
    fail(ErrorKind::usage,
         "{}: {}, fill this store now, and {} must not work in it beside them; wait for them "
         "(dsbuild status), or end them by scancel {}",
         store, jobs_text(mark), what, fmt::join(mark.jobs, " "));
  fail(ErrorKind::usage,
       "{}: {}, may fill this store now, and {} must not work in it beside them: squeue does not "
       "say "
       "here whether they still do; remove {} if not",
       store, jobs_text(mark), what, mark.file.string());
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/store/killed_builds.h"

#include "builder/store/build_ending.h"
#include "builder/store/host.h"
#include "tracer/base/error.h"
#include "tracer/base/temporary_file.h"

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Whether the process has ended and only waits for one that asks how: for ever, where the first
/// process of a container asks for none.
bool has_ended(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() &&
         (text[name_end + 2] == 'Z' || text[name_end + 2] == 'X');
}

/// Whether another process of this number runs on this machine.
bool runs_elsewhere(std::int64_t process) {
  return process != ::getpid() && is_running(process);
}

}  // namespace

bool is_running(std::int64_t process) {
  const bool is_there = ::kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM;
  return is_there && !has_ended(process);
}

void remove_temporaries(const fs::path& folder) {
  // Another process may remove or rename what is being looked at; what vanishes needs no removal.
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    const auto process = process_of_temporary(at->path().filename().string());
    std::error_code ignored;
    if (process && !runs_elsewhere(*process)) fs::remove(at->path(), ignored);
  }
}

bool was_killed(const BuildRow& build) {
  return build.outcome == "running" && build.host == host_name() && !runs_elsewhere(build.process);
}

void clean_up_killed_builds(Dataset& dataset, std::int64_t current) {
  bool any = false;
  for (const BuildRow& build : dataset.database->builds(dataset.row.id)) {
    if (build.number == current || !was_killed(build)) continue;
    any = true;
    dataset.database->update_build(as_ended(dataset, build));
  }
  if (!any) return;
  remove_temporaries(dataset.folder / "images");
  remove_temporaries(dataset.folder / "manifest");
  // Where the store has no locks of its own, other machines write to it.
  if (dataset.claims->file().parent_path() == dataset.store->folder())
    remove_temporaries(dataset.store->folder());
}

}  // namespace ds

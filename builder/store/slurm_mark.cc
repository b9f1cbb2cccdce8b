// SPDX-License-Identifier: Apache-2.0
#include "builder/store/slurm_mark.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fcntl.h>
#include <sstream>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_header = "dsbuild slurm 1";

/// Of "17"; 0 for any other file name.
int number_of(const std::string& name) {
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : 0;
}

/// Wants all of the text in one write, so that no reader sees a part of it.
void write_once(const fs::path& file, int descriptor, const std::string& text) {
  const ssize_t written = ::write(descriptor, text.data(), text.size());
  const int why = written < 0 ? errno : ENOSPC;
  ::close(descriptor);
  if (written == static_cast<ssize_t>(text.size())) return;
  ::unlink(file.c_str());
  fail_system(file, "write", why);
}

std::string text_of(const SlurmMark& mark) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{} {} {}\n", k_header, mark.shards, mark.recipe.string(),
                     mark.folder.string(), mark.since, mark.user, mark.host, mark.process);
}

/// What cannot be read of it stays empty: that it is there is what counts.
SlurmMark read_mark(const fs::path& file) {
  SlurmMark mark;
  mark.file = file;
  std::istringstream text(read_text_file(file));
  std::string header, shards, recipe, folder, who, jobs;
  for (std::string* line : {&header, &shards, &recipe, &folder, &mark.since, &who, &jobs})
    std::getline(text, *line);
  std::istringstream(who) >> mark.user >> mark.host >> mark.process;
  std::istringstream ids(jobs);
  for (std::string id; ids >> id;)
    mark.jobs.push_back(id);
  mark.shards = number_of(shards);
  mark.recipe = recipe;
  mark.folder = folder;
  return mark;
}

}  // namespace

fs::path slurm_folder(const fs::path& store) {
  return store / "slurm";
}

std::optional<SlurmMark> find_slurm_mark(const Store& store) {
  int greatest = 0;
  std::error_code error;
  for (fs::directory_iterator entry(slurm_folder(store.folder()), error), end;
       !error && entry != end; entry.increment(error))
    greatest = std::max(greatest, number_of(entry->path().filename().string()));
  if (greatest == 0) return std::nullopt;
  const fs::path file = slurm_folder(store.folder()) / std::to_string(greatest);
  try {
    return read_mark(file);
  } catch (const Error&) {
    if (!fs::exists(file, error)) return std::nullopt;  // its last job has just ended
    throw;
  }
}

bool make_slurm_mark(const Store& store, const std::optional<SlurmMark>& before, SlurmMark& mark) {
  const fs::path folder = slurm_folder(store.folder());
  make_folders(folder);
  const int number = before ? number_of(before->file.filename().string()) + 1 : 1;
  mark.file = folder / std::to_string(number);
  const int descriptor = ::open(mark.file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST) return false;
  if (descriptor < 0) fail_system(mark.file, "make", errno);
  write_once(mark.file, descriptor, text_of(mark));
  if (before) ::unlink(before->file.c_str());
  return true;
}

void add_jobs(const SlurmMark& mark) {
  const int descriptor = ::open(mark.file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && errno == ENOENT) return;
  if (descriptor < 0) fail_system(mark.file, "write", errno);
  write_once(mark.file, descriptor, fmt::format("{}\n", fmt::join(mark.jobs, " ")));
}

}  // namespace ds

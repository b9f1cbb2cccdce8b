// SPDX-License-Identifier: Apache-2.0
#include "manifests/whole_folder.h"

#include "manifests/manifest.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/process_folder.h"
#include "tracer/base/temporary_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <string_view>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_rename(const fs::path& to) {
  fail(ErrorKind::io, "{}: cannot be replaced: {}", to.string(), std::strerror(errno));
}

/// Where something stands there, both change places.
void rename_or_exchange(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  if (errno == EEXIST &&
      ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0)
    return;
  if (errno != EINVAL && errno != ENOSYS) fail_rename(to);
  // A file system that knows neither: for a moment nothing stands there.
  std::error_code error;
  const fs::path aside = from.string() + ".old";
  if (fs::exists(to, error) && ::rename(to.c_str(), aside.c_str()) != 0) fail_rename(to);
  if (::rename(from.c_str(), to.c_str()) != 0) fail_rename(to);
  fs::remove_all(aside, error);
}

/// Throws where one that is to be replaced holds files that somebody put there.
void check_own(const fs::path& to, const WholeFolderKind& kind) {
  const std::map<std::string, Hash128> own = read_checksum_file(to / kind.checksums);
  std::error_code error;
  for (fs::recursive_directory_iterator entry(to, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string path = entry->path().lexically_relative(to).generic_string();
    if (!entry->is_directory(error) && path != kind.checksums && !own.contains(path))
      fail(ErrorKind::usage,
           "-o {0}: holds {1}, which no {2} put there and a new one would take away; move it, or "
           "choose another folder",
           to.string(), path, kind.name);
  }
}

}  // namespace

fs::path real_place(const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path).lexically_normal() : real;
}

void check_outside(const fs::path& to, const fs::path& dataset) {
  const std::string inside =
      real_place(to).lexically_relative(real_place(dataset)).generic_string();
  for (const std::string_view own : {"images", "manifest", ".dsbuild"})
    if (inside == own || inside.starts_with(std::string(own) + "/"))
      fail(ErrorKind::usage, "-o {}: wanted a folder outside the dataset's own {}", to.string(),
           own);
}

bool is_whole_folder(const fs::path& folder, const WholeFolderKind& kind) {
  std::error_code error;
  return fs::exists(folder / kind.record, error);
}

const WholeFolderKind* whole_folder_kind(const fs::path& folder) {
  for (const WholeFolderKind* kind : {&k_export_folder, &k_gallery_folder, &k_diff_folder})
    if (is_whole_folder(folder, *kind)) return kind;
  return nullptr;
}

fs::path checked_place(const fs::path& to, const WholeFolderKind& kind) {
  fs::path place = fs::absolute(to).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  // What a link leads to is written, and the link stays.
  std::error_code error;
  if (const fs::path real = fs::canonical(place, error); !error) place = real;
  const bool replaces = is_whole_folder(place, kind);
  if (fs::exists(place, error) && !replaces &&
      !(fs::is_directory(place, error) && fs::is_empty(place, error)))
    fail(ErrorKind::usage, "-o {}: is there already and no {} of dsbuild; wanted a new folder",
         place.string(), kind.name);
  if (replaces) check_own(place, kind);
  return place;
}

void remove_leftovers(const fs::path& place, const WholeFolderKind& kind) {
  remove_ended_process_folders(place.parent_path() / kind.work);
}

WholeFolder::WholeFolder(const fs::path& to, const WholeFolderKind& kind)
    : kind_(kind), to_(checked_place(to, kind)), replaces_(is_whole_folder(to_, kind)) {
  work_.path = make_process_folder(to_.parent_path() / kind_.work);
  folder_ = work_.path / to_.filename();
  make_folders(folder_);
}

WholeFolder::WorkFolder::~WorkFolder() {
  if (path.empty()) return;
  std::error_code ignored;
  fs::remove_all(path, ignored);
  fs::remove(path.string() + ".lock", ignored);
  remove_ended_process_folders(path.parent_path());
}

void WholeFolder::enter(const std::string& path, Hash128 hash) {
  check_manifest_path(path);
  if (!checksums_.emplace(path, hash).second)
    fail(ErrorKind::asset, "two images would be written as {}", path);
}

fs::path WholeFolder::new_file(const std::string& path) {
  fs::path file = folder_ / path;
  if (folders_.insert(file.parent_path()).second) make_folders(file.parent_path());
  return file;
}

void WholeFolder::write(const std::string& path, std::span<const std::byte> bytes) {
  enter(path, hash_bytes(bytes));
  Descriptor descriptor(new_file(path), k_write_new);
  descriptor.write(bytes);
  descriptor.close();
}

void WholeFolder::keep(const std::string& path, Hash128 hash, const std::string& before) {
  std::error_code error;
  const fs::path file = new_file(path);
  // The one before goes when this takes its place: nobody writes to both.
  fs::create_hard_link(to_ / before, file, error);
  if (!error) return enter(path, hash);
  write(path, bytes_of(read_text_file(to_ / before)));
}

void WholeFolder::commit() {
  std::string sums;
  for (const auto& [path, hash] : checksums_)
    sums += fmt::format("{}  {}\n", hash.hex(), path);
  write_file_atomic(folder_ / kind_.checksums, sums);
  rename_or_exchange(folder_, to_);
  sync_folder(to_.parent_path());
}

}  // namespace ds

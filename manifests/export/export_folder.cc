// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/export_folder.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/process_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdio.h>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Beside the export's folder, so that it can be renamed into its place.
constexpr const char* k_work_folder = ".dsbuild-export";
constexpr std::size_t k_most_in_batch = 256;

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

std::string checked(std::string path) {
  check_manifest_path(path);
  return path;
}

/// As it is under all links, where that can be told.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path).lexically_normal() : real;
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

/// An export in a dataset would be taken for its files, and the other way round.
void check_apart(const fs::path& dataset, const fs::path& to) {
  if (is_inside(to, dataset) || is_inside(dataset, to))
    fail(ErrorKind::usage, "-o {}: wanted a folder apart from the dataset's, {}", to.string(),
         dataset.string());
}

/// Throws where an export that is to be replaced holds files that somebody put there.
void check_own(const fs::path& to) {
  const std::map<std::string, Hash128> own = read_checksum_file(to / k_export_checksums);
  std::error_code error;
  for (fs::recursive_directory_iterator entry(to, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string path = entry->path().lexically_relative(to).generic_string();
    if (!entry->is_directory(error) && path != k_export_checksums && !own.contains(path))
      fail(ErrorKind::usage,
           "-o {}: holds {}, which no export put there and a new one would take away; move it, or "
           "export to another folder",
           to.string(), path);
  }
}

}  // namespace

std::string read_checked(const fs::path& folder, const FileRecord& file) {
  check_manifest_path(file.path);
  std::error_code error;
  if (!fs::exists(folder / file.path, error))
    fail(ErrorKind::asset, "{}: is missing; dsbuild build makes it again",
         (folder / file.path).string());
  if (!fs::is_regular_file(folder / file.path, error))
    fail(ErrorKind::asset, "{}: is no regular file", (folder / file.path).string());
  std::string bytes = read_text_file(folder / file.path);
  if (hash_text(bytes) != file.hashes.xxh128)
    fail(ErrorKind::asset,
         "{}: is not what the manifest says, as after an edit, or while a build is under way; "
         "dsbuild "
         "verify tells more",
         (folder / file.path).string());
  return bytes;
}

ExportFolder::ExportFolder(fs::path from, fs::path to, bool copy)
    : from_(std::move(from)), to_(fs::absolute(to).lexically_normal()), copy_(copy) {
  if (!to_.has_filename()) to_ = to_.parent_path();
  // What a link leads to is written, and the link stays.
  std::error_code error;
  if (const fs::path real = fs::canonical(to_, error); !error) to_ = real;
  check_apart(place_of(from_), place_of(to_));
  const bool replaces = fs::exists(to_ / k_export_record, error);
  if (fs::exists(to_, error) && !replaces &&
      !(fs::is_directory(to_, error) && fs::is_empty(to_, error)))
    fail(ErrorKind::usage, "-o {}: is there already and no export of dsbuild; wanted a new folder",
         to_.string());
  if (replaces) check_own(to_);
  work_.path = make_process_folder(to_.parent_path() / k_work_folder);
  folder_ = work_.path / to_.filename();
  make_folders(folder_);
}

ExportFolder::~ExportFolder() = default;

ExportFolder::WorkFolder::~WorkFolder() {
  if (path.empty()) return;
  std::error_code ignored;
  fs::remove_all(path, ignored);
  fs::remove(path.string() + ".lock", ignored);
  fs::remove(path.parent_path(), ignored);  // where no other export is under way
}

void ExportFolder::enter(const std::string& path, Hash128 hash, std::uint64_t bytes) {
  check_manifest_path(path);
  if (!checksums_.emplace(path, hash).second)
    fail(ErrorKind::asset, "two images would be exported as {}", path);
  bytes_ += bytes;
}

void ExportFolder::flush() {
  if (batch_) batch_->commit();
  batch_.reset();
  in_batch_ = 0;
}

void ExportFolder::place(const FileRecord& file, const std::string& path) {
  check_manifest_path(file.path);
  std::error_code error;
  if (!fs::is_regular_file(from_ / file.path, error) ||
      content_hash(from_ / file.path) != file.hashes.xxh128)
    read_checked(from_, file);  // throws
  enter(path, file.hashes.xxh128, file.hashes.size_bytes);
  if (!batch_) batch_ = std::make_unique<FileBatch>();
  if (copy_)
    batch_->copy(from_ / file.path, folder_ / path);
  else
    batch_->link(from_ / file.path, folder_ / path);
  if (++in_batch_ == k_most_in_batch) flush();
}

void ExportFolder::write(const std::string& path, std::string_view text) {
  check_manifest_path(path);
  enter(path, hash_text(text), text.size());
  write_file_atomic(folder_ / path, text);
}

ExportFolder::Stream::Stream(ExportFolder& folder, std::string path)
    : folder_(folder), path_(checked(std::move(path))), writer_(folder.folder_ / path_) {}

void ExportFolder::Stream::write(std::string_view text) {
  writer_.write(text);
  hash_.add(text);
  bytes_ += text.size();
}

void ExportFolder::Stream::close() {
  writer_.commit();
  folder_.enter(path_, hash_.hash(), bytes_);
}

void ExportFolder::note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

void ExportFolder::commit(const std::string& record) {
  flush();
  write(k_export_record, record);
  std::string sums;
  for (const auto& [path, hash] : checksums_)
    sums += fmt::format("{}  {}\n", hash.hex(), path);
  write_file_atomic(folder_ / k_export_checksums, sums);
  rename_or_exchange(folder_, to_);
  sync_folder(to_.parent_path());
}

}  // namespace ds

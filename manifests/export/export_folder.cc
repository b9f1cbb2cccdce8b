// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/export_folder.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_in_batch = 256;

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

/// `to`: an export in a dataset would be taken for its files, and the other way round.
const fs::path& apart(const fs::path& dataset, const fs::path& to) {
  const fs::path own = place_of(dataset), other = place_of(to);
  if (is_inside(other, own) || is_inside(own, other))
    fail(ErrorKind::usage, "-o {}: wanted a folder apart from the dataset's, {}", to.string(),
         dataset.string());
  return to;
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

ExportFolder::ExportFolder(fs::path from, const fs::path& to, bool copy)
    : from_(std::move(from)), whole_(apart(from_, to), k_export_folder), copy_(copy) {}

ExportFolder::~ExportFolder() = default;

void ExportFolder::enter(const std::string& path, Hash128 hash, std::uint64_t bytes) {
  whole_.enter(path, hash);
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
    batch_->copy(from_ / file.path, whole_.folder() / path);
  else
    batch_->link(from_ / file.path, whole_.folder() / path);
  if (++in_batch_ == k_most_in_batch) flush();
}

void ExportFolder::write(const std::string& path, std::string_view text) {
  check_manifest_path(path);
  enter(path, hash_text(text), text.size());
  write_file_atomic(whole_.folder() / path, text);
}

ExportFolder::Stream::Stream(ExportFolder& folder, std::string path)
    : folder_(folder), path_(checked(std::move(path))), writer_(folder.whole_.folder() / path_) {}

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
  write(k_export_folder.record, record);
  whole_.commit();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/files.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/file_batch.h"
#include "tracer/base/file_writer.h"
#include "tracer/base/hash.h"
#include "tracer/base/regular_file.h"
#include "tracer/base/temporary_file.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string read_text_file(const fs::path& path) {
  const Descriptor file = open_regular(path);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail_errno(path, "look at");
  // One byte more than it has, so that its end is seen at once; those of /proc tell no size.
  constexpr std::size_t k_least = 4096;
  std::string text(std::max(k_least, static_cast<std::size_t>(info.st_size) + 1), '\0');
  std::size_t size = 0;
  while (const std::size_t got = file.read(std::span(text).subspan(size))) {
    size += got;
    if (size == text.size()) text.resize(2 * size);
  }
  text.resize(size);
  return text;
}

void make_folders(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail_system(folder, "make the folder", error.value());
}

void sync_folder(const fs::path& folder) {
  Descriptor(folder, O_RDONLY | O_DIRECTORY).sync();
}

void write_file_atomic(const fs::path& path, std::span<const std::byte> bytes) {
  FileBatch batch;
  batch.write(path, bytes);
  batch.commit();
}

/// Opened at the first write that the buffer has no room for.
struct FileWriter::State {
  static constexpr std::size_t k_buffer = 1U << 16U;

  fs::path path, target;
  std::optional<TemporaryName> temporary;
  std::optional<Descriptor> file;
  std::string buffer;

  void flush() {
    if (!file) {
      target = prepare_target(path);
      temporary.emplace(target);
      file.emplace(temporary->path(), k_write_new, target);
    }
    file->write(bytes_of(buffer));
    buffer.clear();
  }
};

FileWriter::FileWriter(const fs::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
}

FileWriter::~FileWriter() = default;

void FileWriter::write(std::string_view text) {
  state_->buffer += text;
  if (state_->buffer.size() >= State::k_buffer) state_->flush();
}

void FileWriter::commit() {
  state_->flush();
  state_->file->sync();
  state_->file->close();
  state_->temporary->rename_to(state_->target);
  sync_folder(state_->target.parent_path());
}

void write_file_atomic(const fs::path& path, std::string_view text) {
  write_file_atomic(path, bytes_of(text));
}

void link_file_atomic(const fs::path& from, const fs::path& to) {
  FileBatch batch;
  batch.link(from, to);
  batch.commit();
}

void copy_file_atomic(const fs::path& from, const fs::path& to) {
  FileBatch batch;
  batch.copy(from, to);
  batch.commit();
}

bool may_write(const fs::path& file) {
  return ::faccessat(AT_FDCWD, file.c_str(), W_OK, AT_EACCESS) == 0;
}

void remove_write_permission(const fs::path& file) {
  constexpr auto k_all_write =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  std::error_code ignored;
  if ((fs::status(file, ignored).permissions() & k_all_write) == fs::perms::none) return;
  fs::permissions(file, k_all_write, fs::perm_options::remove, ignored);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "dsbuild-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) fail_errno(name, "make a temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // a destructor has nobody to tell
  fs::remove_all(path_, ignored);
}

}  // namespace ds

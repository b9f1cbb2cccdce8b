// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/files.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/file_writer.h"
#include "tracer/base/hash.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <linux/fs.h>
#include <memory>
#include <optional>
#include <random>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_errno(const fs::path& path, const char* what) {
  fail_system(path, what, errno);
}

/// Tells the processes of several machines apart that share a folder.
unsigned process_token() {
  static const unsigned token = std::random_device{}();
  return token;
}

/// An open file descriptor that closes itself; `close` reports what the destructor has to swallow.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags)
      : path_(path), fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) fail_errno(path, "open");
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  void sync() const {
    if (::fsync(fd_) != 0) fail_errno(path_, "sync");
  }
  void close() {
    const int fd = std::exchange(fd_, -1);
    if (::close(fd) != 0) fail_errno(path_, "close");
  }

 private:
  fs::path path_;
  int fd_;
};

/// Removes the file unless it was renamed away.
class TemporaryName {
 public:
  explicit TemporaryName(const fs::path& target) {
    // Without the target's name, which may be as long as names can be.
    static std::atomic<unsigned> counter{0};
    path_ = target.parent_path() /
            fmt::format(".{:08x}.{}.{}.tmp", process_token(), ::getpid(), counter.fetch_add(1));
  }
  ~TemporaryName() {
    if (!renamed_) ::unlink(path_.c_str());
  }
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;
  const fs::path& path() const { return path_; }
  void rename_to(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0)
      fail_errno(target, "rename a finished temporary to");
    renamed_ = true;
    sync_folder(target.parent_path());
  }

 private:
  fs::path path_;
  bool renamed_ = false;
};

/// A target with a parent folder, which exists.
fs::path prepare_target(const fs::path& path) {
  fs::path target = fs::absolute(path);
  make_folders(target.parent_path());
  return target;
}

void write_all(const Descriptor& file, const fs::path& path, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file.get(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail_errno(path, "write");
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

/// As `process_token` makes them, two writers could still have one name; then this one fails.
constexpr int k_write_new = O_WRONLY | O_CREAT | O_EXCL;

bool reflink(const fs::path& from, const fs::path& to) {
  const Descriptor source(from, O_RDONLY);
  Descriptor target(to, k_write_new);
  const bool cloned = ::ioctl(target.get(), FICLONE, source.get()) == 0;
  if (cloned) target.sync();
  target.close();
  return cloned;
}

}  // namespace

std::string read_text_file(const fs::path& path) {
  std::error_code
      unknown;  // what keeps us from looking keeps us from opening too, and is told then
  if (fs::is_directory(path, unknown))
    fail(ErrorKind::io, "{}: wanted a file, found a folder", path.string());
  std::ifstream in(path, std::ios::binary);
  if (!in) fail_errno(path, "open");
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (in.bad()) fail_errno(path, "read");
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
  const fs::path target = prepare_target(path);
  TemporaryName temporary(target);
  Descriptor file(temporary.path(), k_write_new);
  write_all(file, target, bytes);
  file.sync();
  file.close();
  temporary.rename_to(target);
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
      file.emplace(temporary->path(), k_write_new);
    }
    write_all(*file, target, bytes_of(buffer));
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
}

void write_file_atomic(const fs::path& path, std::string_view text) {
  write_file_atomic(path, bytes_of(text));
}

void link_file_atomic(const fs::path& from, const fs::path& to) {
  const fs::path target = prepare_target(to);
  {
    TemporaryName temporary(target);
    if (reflink(from, temporary.path())) {
      temporary.rename_to(target);
      return;
    }
  }
  remove_write_permission(from);
  if (!may_write(from)) {
    std::error_code absent;
    // rename() does nothing where both names are links to one file already, and would leave the
    // temporary behind.
    if (fs::equivalent(from, target, absent)) return;
    TemporaryName temporary(target);
    if (::link(from.c_str(), temporary.path().c_str()) == 0) {
      temporary.rename_to(target);
      return;
    }
  }
  copy_file_atomic(from, target);
}

void copy_file_atomic(const fs::path& from, const fs::path& to) {
  write_file_atomic(to, read_text_file(from));
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

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/file_batch.h"

#include "tracer/base/files.h"
#include "tracer/base/hash.h"
#include "tracer/base/regular_file.h"
#include "tracer/base/temporary_file.h"

#include <linux/fs.h>
#include <linux/magic.h>
#include <map>
#include <set>
#include <string>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <sys/vfs.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Before Linux 5.8 syncfs kept silent about data that could not be written.
bool syncfs_tells_errors() {
  static const bool tells = [] {
    utsname system{};
    int major = 0, minor = 0;
    if (::uname(&system) != 0) return false;
    const std::string release = system.release;
    const std::size_t dot = release.find('.');
    if (dot == std::string::npos) return false;
    try {
      major = std::stoi(release);
      minor = std::stoi(release.substr(dot + 1));
    } catch (const std::exception&) {
      return false;
    }
    return major > 5 || (major == 5 && minor >= 8);
  }();
  return tells;
}

/// A file system known to keep with one syncfs what an fsync of each file keeps. Of others, which
/// hand files on to a server or a process, that is not known.
bool keeps_by_syncfs(const Descriptor& folder) {
  struct statfs info {};
  if (::fstatfs(folder.get(), &info) != 0) return false;
  constexpr long k_xfs = 0x58465342;
  for (const long known : {long{EXT4_SUPER_MAGIC}, k_xfs, long{BTRFS_SUPER_MAGIC},
                           long{F2FS_SUPER_MAGIC}, long{TMPFS_MAGIC}})
    if (info.f_type == known) return true;
  return false;
}

bool reflink(const fs::path& from, const fs::path& to) {
  const Descriptor source = open_regular(from);
  Descriptor target(to, k_write_new);
  const bool cloned = ::ioctl(target.get(), FICLONE, source.get()) == 0;
  target.close();
  return cloned;
}

}  // namespace

struct FileBatch::State {
  struct Item {
    TemporaryName temporary;
    fs::path target;
    bool data;  ///< has bytes that are not yet on the disk
  };
  struct Volume {
    Descriptor folder;  ///< opened before anything is written, so that it hears of all errors
    bool by_syncfs;
  };

  /// A file more of a folder that is there, and its volume known.
  Item new_item(const fs::path& path) {
    fs::path target = prepare_target(path);
    folders.insert(target.parent_path());
    Descriptor folder(target.parent_path(), O_RDONLY | O_DIRECTORY);
    struct stat info {};
    if (::fstat(folder.get(), &info) != 0) fail_errno(target.parent_path(), "look at");
    if (!volumes.contains(info.st_dev)) {
      const bool by_syncfs = syncfs_tells_errors() && keeps_by_syncfs(folder);
      volumes.emplace(info.st_dev, Volume{std::move(folder), by_syncfs});
    }
    return {TemporaryName(target), std::move(target), true};
  }

  /// Whether all is kept by one call a volume: not of one file, which need not wait for others'.
  bool by_volume(std::size_t files) const {
    bool all = files > 1;
    for (const auto& [device, volume] : volumes)
      all = all && volume.by_syncfs;
    return all;
  }
  void sync_volumes() {
    for (const auto& [device, volume] : volumes)
      if (::syncfs(volume.folder.get()) != 0) fail_errno(items.front().target, "sync");
  }

  std::vector<Item> items;
  std::set<fs::path> folders;
  std::map<dev_t, Volume> volumes;
};

FileBatch::FileBatch() : state_(std::make_unique<State>()) {}

FileBatch::~FileBatch() = default;

void FileBatch::write(const fs::path& path, std::span<const std::byte> bytes) {
  State::Item item = state_->new_item(path);
  Descriptor file(item.temporary.path(), k_write_new, item.target);
  file.write(bytes);
  file.close();
  state_->items.push_back(std::move(item));
}

void FileBatch::link(const fs::path& from, const fs::path& to) {
  {
    State::Item item = state_->new_item(to);
    if (reflink(from, item.temporary.path())) {
      state_->items.push_back(std::move(item));
      return;
    }
  }
  remove_write_permission(from);
  if (!may_write(from)) {
    std::error_code absent;
    // rename() does nothing where both names are links to one file already, and would leave the
    // temporary behind.
    if (fs::equivalent(from, to, absent)) return;
    State::Item item = state_->new_item(to);
    if (::link(from.c_str(), item.temporary.path().c_str()) == 0) {
      item.data = false;
      state_->items.push_back(std::move(item));
      return;
    }
  }
  copy(from, to);
}

void FileBatch::copy(const fs::path& from, const fs::path& to) {
  write(to, bytes_of(read_text_file(from)));
}

void FileBatch::commit() {
  if (state_->items.empty()) return;
  const bool by_volume = state_->by_volume(state_->items.size());
  if (by_volume) {
    state_->sync_volumes();
  } else {
    for (const State::Item& item : state_->items)
      if (item.data) Descriptor(item.temporary.path(), O_RDONLY).sync();
  }
  for (State::Item& item : state_->items)
    item.temporary.rename_to(item.target);
  if (by_volume) {
    state_->sync_volumes();
  } else {
    for (const fs::path& folder : state_->folders)
      sync_folder(folder);
  }
  state_->items.clear();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/store/folder_lock.h"

#include <array>
#include <limits>
#include <unistd.h>

namespace ds {
namespace {

constexpr long k_gate = 0;
constexpr long k_end = std::numeric_limits<long>::max();

std::string read_who(int descriptor) {
  std::array<char, 4096> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  std::string who(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  return who.empty() ? "another process" : who;
}

/// For people only: what is lost of it on a full disk is no reason to fail.
void write_who(int descriptor, const std::string& who) {
  if (::ftruncate(descriptor, 0) != 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, who.data(), who.size(), 0);
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / "build") {}

FolderLock::Gate::Gate(FolderLock& lock) : lock_(lock) {
  lock_.file_.take(LockFile::Lock::exclusive, k_gate);
}

FolderLock::Gate::~Gate() {
  lock_.file_.release(k_gate);
}

std::optional<std::string> FolderLock::try_join(Hash128 what, const std::string& who) {
  const Gate gate(*this);
  const long own = LockFile::offset_of(what);
  if (file_.others_hold(k_gate + 1, own) || file_.others_hold(own + 1, k_end))
    return read_who(file_.descriptor());
  file_.take(LockFile::Lock::shared, own);
  held_ = own;
  write_who(file_.descriptor(), who);
  return std::nullopt;
}

void FolderLock::leave() {
  if (held_) file_.release(*held_);
  held_.reset();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/make/made_journal.h"

#include <cstddef>
#include <sys/mman.h>
#include <unistd.h>

namespace ds {
namespace {

/// Only processes of one program read each other's.
struct Entry {
  Hash128 image;
  std::uint64_t samples = 0;
  bool traced = false, developed = false, placed = false;
};

}  // namespace

ImageWork together(const ImageWork& earlier, const ImageWork& later) {
  return {earlier.traced || later.traced, earlier.developed || later.developed,
          later.traced ? later.samples : earlier.samples};
}

MadeJournal::MadeJournal() : file_(::memfd_create("dsbuild-made", MFD_CLOEXEC)) {}

MadeJournal::~MadeJournal() {
  if (file_ >= 0) ::close(file_);
}

void MadeJournal::begin(std::string_view id, const ImageWork& work) {
  const std::lock_guard lock(mutex_);
  const off_t end = file_ >= 0 ? ::lseek(file_, 0, SEEK_END) : -1;
  const Entry entry{hash_text(id), work.samples, work.traced, work.developed, false};
  if (end < 0 || ::pwrite(file_, &entry, sizeof entry, end) != sizeof entry) return;
  begun_[entry.image] = end;
}

void MadeJournal::placed(std::string_view id) {
  const std::lock_guard lock(mutex_);
  const auto begun = begun_.find(hash_text(id));
  if (begun == begun_.end()) return;
  constexpr bool k_placed = true;
  // A byte of a page that is there already: it cannot fail for want of memory.
  static_cast<void>(::pwrite(file_, &k_placed, sizeof k_placed,
                             begun->second + static_cast<off_t>(offsetof(Entry, placed))));
  begun_.erase(begun);
}

MadeImages MadeJournal::read() const {
  MadeImages made;
  Entry entry;
  for (off_t at = 0; file_ >= 0 && ::pread(file_, &entry, sizeof entry, at) == sizeof entry;
       at += static_cast<off_t>(sizeof entry)) {
    const ImageWork work{entry.traced, entry.developed, entry.samples};
    MadeImage& image = made[entry.image];
    image = {together(image.work, work), image.placed || entry.placed};
  }
  return made;
}

}  // namespace ds

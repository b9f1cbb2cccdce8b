// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/traced_image.h"
#include "tracer/base/hash.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string_view>

namespace ds {

/// What a process that died had made of an image. Without `placed` it may not have come to it: then
/// only where no more is to be traced of the image was it made.
struct MadeImage {
  ImageWork work;
  bool placed = false;
};

/// The work on an image of which one process traced what a later one placed.
ImageWork together(const ImageWork& earlier, const ImageWork& later);

/// By the hash of an image's id.
using MadeImages = std::map<Hash128, MadeImage>;

/// Images as they are kept, in memory that the processes of one build share, so that none is counted
/// twice or not at all where the process that made it dies before it tells. Of each image an entry is made before it is
/// committed, and marked once its files are in place: a death in between leaves what `MadeImage` says.
/// Where the system gives no memory for it, or no more, what is not entered is not known to have
/// been made. Safe from any thread.
class MadeJournal {
 public:
  MadeJournal();
  ~MadeJournal();
  MadeJournal(const MadeJournal&) = delete;
  MadeJournal& operator=(const MadeJournal&) = delete;

  /// About to be committed.
  void begin(std::string_view id, const ImageWork& work);
  /// In place, of those begun by this process.
  void placed(std::string_view id);
  /// Of all processes so far.
  MadeImages read() const;

 private:
  int file_ = -1;
  std::mutex mutex_;
  std::map<Hash128, std::int64_t> begun_;  ///< by this process: where their entries are
};

}  // namespace ds

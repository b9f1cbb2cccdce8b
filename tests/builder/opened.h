// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <sys/inotify.h>
#include <unistd.h>
#include <vector>

namespace ds {

/// Counts what is opened in folders, by anyone.
class Opened {
 public:
  explicit Opened(const std::vector<std::filesystem::path>& folders)
      : descriptor_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    for (const std::filesystem::path& folder : folders)
      EXPECT_GE(::inotify_add_watch(descriptor_, folder.c_str(), IN_OPEN | IN_CREATE), 0) << folder;
  }
  ~Opened() { ::close(descriptor_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  /// Files opened or made since the last call; folders may be listed.
  int files() {
    int count = 0;
    alignas(inotify_event) std::array<char, 1 << 16> events{};
    for (;;) {
      const ssize_t size = ::read(descriptor_, events.data(), events.size());
      if (size <= 0) return count;
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(events.data() + at);
        if ((event->mask & IN_ISDIR) == 0U) ++count;
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
  }

 private:
  int descriptor_;
};

}  // namespace ds

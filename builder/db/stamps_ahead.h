// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/file_stamp.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <thread>

namespace ds {

/// Looks whether thousands of files have their stamps still, in a thread of its own, beside the work
/// that asks for them: from the last file to the first, while its owner asks from the first on.
/// Where they meet, each file was looked at once.
class StampsAhead {
 public:
  /// A file as one of them knows it: its path in the open folder, and its stamp.
  struct File {
    const char* path = nullptr;
    const FileStamp* stamp = nullptr;  ///< null: nothing is known, it is not looked at
  };

  /// `file(i)` is called from the thread too; until this goes it must give the same for a file that
  /// `is_known` was not asked of, and the folder must stay open. Where no thread can be had the
  /// owner looks at all.
  StampsAhead(int folder, std::size_t count, std::function<File(std::size_t)> file);
  ~StampsAhead();
  StampsAhead(const StampsAhead&) = delete;
  StampsAhead& operator=(const StampsAhead&) = delete;

  /// Whether file i had its stamp when it was looked at, since this was made. False where nobody
  /// has looked yet: from then on the thread leaves it alone. From the owner's thread only.
  bool is_known(std::size_t i);

 private:
  enum class State : unsigned char { open, looking, as_known, other };
  void look_at_all();

  int folder_;
  std::size_t count_;
  std::function<File(std::size_t)> file_;
  std::unique_ptr<std::atomic<State>[]> states_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace ds

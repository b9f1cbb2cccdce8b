// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ds {

/// "12 of 90 models read": a line on a terminal, a few times a second, gone when this goes.
class WorkProgress {
 public:
  explicit WorkProgress(std::string what);
  ~WorkProgress();
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;
  void operator()(std::uint64_t done, std::uint64_t all);

 private:
  std::string what_;
  bool moves_;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace ds

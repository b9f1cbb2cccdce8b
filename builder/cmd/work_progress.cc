// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/work_progress.h"

#include "tracer/base/streams.h"

#include <fmt/format.h>

#include <utility>

namespace ds {

WorkProgress::WorkProgress(std::string what) : what_(std::move(what)), moves_(has_status_line()) {}

WorkProgress::~WorkProgress() {
  clear_status_line();
}

void WorkProgress::operator()(std::uint64_t done, std::uint64_t all) {
  const auto now = std::chrono::steady_clock::now();
  if (!moves_ || (now - shown_ < std::chrono::milliseconds(200) && done < all)) return;
  shown_ = now;
  show_status_line(fmt::format("{} of {} {}", done, all, what_));
}

}  // namespace ds

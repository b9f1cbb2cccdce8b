// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/log.h"

#include "tracer/base/streams.h"

#include <atomic>
#include <mutex>
#include <set>
#include <string>

namespace ds {
namespace {

std::atomic<std::uint64_t> warnings{0};

bool is_new(std::string_view message) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> said;
  const std::lock_guard lock(mutex);
  return said.emplace(message).second;
}

}  // namespace

void warn(std::string_view message) {
  ++warnings;
  if (is_new(message)) say(Stream::people, "dsbuild: warning: {}\n", message);
}

std::uint64_t warning_count() {
  return warnings;
}

}  // namespace ds

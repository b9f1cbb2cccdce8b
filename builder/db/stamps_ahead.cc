// SPDX-License-Identifier: Apache-2.0
#include "builder/db/stamps_ahead.h"

#include "tracer/base/error.h"

#include <system_error>
#include <utility>

namespace ds {

StampsAhead::StampsAhead(int folder, std::size_t count, std::function<File(std::size_t)> file)
    : folder_(folder),
      count_(count),
      file_(std::move(file)),
      states_(std::make_unique<std::atomic<State>[]>(count)) {
  constexpr std::size_t k_worth_a_thread = 256;
  if (folder < 0 || count < k_worth_a_thread) return;
  try {
    thread_ = std::thread([this] { look_at_all(); });
  } catch (const std::system_error&) {  // the system has no more of them
  }
}

StampsAhead::~StampsAhead() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void StampsAhead::look_at_all() {
  for (std::size_t i = count_; i-- > 0 && !stop_;) {
    State expected = State::open;
    if (!states_[i].compare_exchange_strong(expected, State::looking, std::memory_order_acquire))
      continue;
    State found = State::other;
    try {
      const File file = file_(i);
      if (file.stamp != nullptr && stamp_in(folder_, file.path) == *file.stamp)
        found = State::as_known;
    } catch (const Error&) {  // the owner finds it too, and says so
    }
    states_[i].store(found, std::memory_order_release);
  }
}

bool StampsAhead::is_known(std::size_t i) {
  State state = State::open;
  if (states_[i].compare_exchange_strong(state, State::other, std::memory_order_acquire))
    return false;
  for (; state == State::looking; state = states_[i].load(std::memory_order_acquire))
    std::this_thread::yield();
  return state == State::as_known;
}

}  // namespace ds

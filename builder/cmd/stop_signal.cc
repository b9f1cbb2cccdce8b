// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/stop_signal.h"

#include <csignal>
#include <ctime>

namespace ds {
namespace {

constexpr int k_signals[] = {SIGINT, SIGTERM, SIGHUP};

/// One wish to stop often comes as two signals: timeout(1) sends its own to the process and to its
/// group, a terminal that goes away makes shell and kernel send one each. What comes sooner than
/// this is no second wish.
constexpr long k_one_wish_ms = 200;

std::atomic<bool> g_stop{false};
std::atomic<int> g_signal{0};
std::atomic<long> g_since_ms{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
                  std::atomic<long>::is_always_lock_free,
              "a signal handler may only touch what needs no lock");

long now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);  // a handler may call it
  return now.tv_sec * 1000 + now.tv_nsec / 1'000'000;
}

void die_of(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

extern "C" void set_stop(int signal) {
  int none = 0;
  if (g_signal.compare_exchange_strong(none, signal)) {
    g_since_ms = now_ms();
    g_stop = true;
  } else if (signal != SIGHUP && g_since_ms > 0 && now_ms() - g_since_ms > k_one_wish_ms) {
    die_of(signal);
  }
}

}  // namespace

const std::atomic<bool>& stop_on_signal() {
  struct sigaction action = {};
  action.sa_handler = set_stop;
  action.sa_flags = SA_RESTART;
  for (const int signal : k_signals) {
    struct sigaction before = {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    ::sigaction(signal, &action, nullptr);
  }
  return g_stop;
}

bool stopped_by_signal() {
  return g_stop;
}

void die_of_stop_signal() {
  if (g_stop) die_of(g_signal);
}

}  // namespace ds

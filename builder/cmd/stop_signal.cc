// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/stop_signal.h"

#include <chrono>
#include <csignal>
#include <optional>
#include <system_error>
#include <thread>

namespace ds {
namespace {

using Clock = std::chrono::steady_clock;

/// LSF and Grid Engine send SIGUSR1,
/// SIGUSR2 or SIGXCPU before their SIGKILL, Slurm what its --signal says.
constexpr int k_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1, SIGUSR2};

/// One wish to stop often comes as two signals: timeout(1) sends its own to the process and to its
/// group, a terminal that goes away makes shell and kernel send one each. What comes sooner than
/// this is no second wish.
constexpr std::chrono::milliseconds k_one_wish{200};

std::atomic<bool> g_armed{false};  ///< a signal is a wish to end cleanly, not the end
std::atomic<bool> g_stop{false};
std::atomic<int> g_signal{0};

/// SIGXCPU comes every second once the limit is passed, the others by the batch system's clock.
bool is_users(int signal) {
  return signal == SIGINT || signal == SIGTERM || signal == SIGQUIT;
}

sigset_t set_of(int signal) {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, signal);
  return set;
}

void watch(sigset_t signals) {
  std::optional<Clock::time_point> since;  // the first wish
  for (;;) {
    int signal = 0;
    if (::sigwait(&signals, &signal) != 0) continue;
    if (!g_armed) die_of_signal(signal);
    if (!since) {
      since = Clock::now();
      g_signal = signal;
      g_stop = true;
    } else if (is_users(signal) && Clock::now() - *since > k_one_wish) {
      die_of_signal(signal);
    }
  }
}

}  // namespace

std::span<const int> stop_signals() {
  return k_signals;
}

void watch_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : k_signals) {
    struct sigaction before = {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    ::sigaddset(&signals, signal);
  }
  sigset_t before;
  if (::pthread_sigmask(SIG_BLOCK, &signals, &before) != 0) return;
  try {
    std::thread(watch, signals).detach();
  } catch (const std::system_error&) {  // no threads are left: signals end the process as ever
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
}

const std::atomic<bool>& stop_on_signal() {
  g_armed = true;
  return g_stop;
}

bool stopped_by_signal() {
  return g_stop;
}

void die_of_signal(int signal) {
  std::signal(signal, SIG_DFL);
  const sigset_t one = set_of(signal);
  ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  std::raise(signal);
}

void die_of_stop_signal() {
  if (g_stop) die_of_signal(g_signal);
}

}  // namespace ds

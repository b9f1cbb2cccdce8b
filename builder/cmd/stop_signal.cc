// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/stop_signal.h"

#include <csignal>

namespace ds {
namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free,
              "a signal handler may only touch what needs no lock");

extern "C" void set_stop(int /*signal*/) {
  g_stop = true;
}

}  // namespace

const std::atomic<bool>& stop_on_signal() {
  struct sigaction action = {};
  action.sa_handler = set_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | static_cast<unsigned>(SA_RESTART));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    ::sigaction(signal, &action, nullptr);
  return g_stop;
}

}  // namespace ds

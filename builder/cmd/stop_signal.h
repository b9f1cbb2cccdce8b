// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <span>

namespace ds {

/// What a user, a terminal or a batch system ends a process by.
std::span<const int> stop_signals();

/// To be called once, before any thread is started. A thread waits for the signals from then on, and
/// all others block them: OpenCL's compiler handles signals in its own way once it is loaded, and
/// would take some for good. A signal that was ignored when the process began stays so: that is all
/// that nohup does, and a shell without job control for what runs in its background.
void watch_signals();

/// Set by the first SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1 or SIGUSR2 after the first
/// call; what is under way is to end cleanly then. Before that call they end the process, and so
/// does a second SIGINT, SIGTERM or SIGQUIT, a moment later.
const std::atomic<bool>& stop_on_signal();

/// Whether a signal has set it.
bool stopped_by_signal();

/// Ends the process by the signal that set it, as if it had not been caught: a shell then ends its
/// script too, and the exit status says which signal it was (128 + its number). Returns where none
/// has.
void die_of_stop_signal();
void die_of_signal(int signal);

}  // namespace ds

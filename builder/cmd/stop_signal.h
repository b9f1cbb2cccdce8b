// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace ds {

/// Set by the first SIGINT, SIGTERM or SIGHUP after the first call; what is under way is to end
/// cleanly then. A second SIGINT or SIGTERM, a moment later, ends the process at once, as without
/// this. A signal that was ignored when the process began stays so: that is all that nohup does,
/// and a shell without job control for what runs in its background.
const std::atomic<bool>& stop_on_signal();

/// Whether a signal has set it.
bool stopped_by_signal();

/// Ends the process by the signal that set it, as if it had not been caught: a shell then ends its
/// script too, and the exit status says which signal it was (128 + its number). Returns where none
/// has.
void die_of_stop_signal();

}  // namespace ds

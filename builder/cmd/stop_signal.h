// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace ds {

/// Set by the first SIGINT, SIGTERM or SIGHUP after the first call; a second one ends the process
/// at once, as without this. What is under way is to end cleanly when it is set.
const std::atomic<bool>& stop_on_signal();

}  // namespace ds

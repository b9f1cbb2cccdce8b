// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace ds {

/// Calls work(begin, end) for ranges that together are 0 .. count - 1, each once, on as many
/// threads as the machine has processors, and waits for all. Ranges have `least` numbers at least
/// (but there may be less in all), so that little work is not shared out. What a range throws is
/// thrown here once all have ended, the first range's first.
void parallel_ranges(std::size_t count, std::size_t least,
                     const std::function<void(std::size_t begin, std::size_t end)>& work);

}  // namespace ds

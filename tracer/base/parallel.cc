// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/parallel.h"

#include <algorithm>
#include <exception>
#include <future>
#include <thread>
#include <vector>

namespace ds {

void parallel_ranges(std::size_t count, std::size_t least,
                     const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t threads = std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  const std::size_t ranges =
      std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, threads);
  // Where no further thread can be had, the library runs these at the waiting below.
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < ranges; ++i)
    others.push_back(std::async(
        [&work, i, count, ranges] { work(count * i / ranges, count * (i + 1) / ranges); }));
  std::exception_ptr failure;
  const auto keep_first = [&](const auto& step) {
    try {
      step();
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  };
  keep_first([&] { work(0, count / ranges); });
  for (std::future<void>& other : others)
    keep_first([&] { other.get(); });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/shard.h"

#include "tracer/base/error.h"
#include "tracer/base/hash.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace ds {
namespace {

/// More than there are machines to share a dataset: a larger number is a slip.
constexpr std::uint32_t k_most_shards = 65536;

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

bool Shard::holds(std::string_view image_id) const {
  if (count == 1) return true;
  // The text is part of what builds agree on: never change it.
  return hash64_text(fmt::format("shard {}", image_id)) % count == number - 1;
}

Shard read_shard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto number = whole_number(text.substr(0, slash));
  const auto count = whole_number(text.substr(std::min(slash + 1, text.size())));
  if (!number || !count || *number < 1 || *number > *count || *count > k_most_shards)
    fail(ErrorKind::usage, "--shard: wanted I/N with 1 <= I <= N <= {}, such as 2/4, got {}",
         k_most_shards, text);
  return {*number, *count};
}

}  // namespace ds

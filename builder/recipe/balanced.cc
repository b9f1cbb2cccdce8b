// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/balanced.h"

#include "builder/recipe/seeded_hash.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <tuple>

namespace ds {
namespace {

constexpr std::string_view k_for_order = "balanced order";

}  // namespace

std::size_t highest_hash(std::uint64_t seed, std::string_view purpose, const Chooser& chooser,
                         const std::vector<std::string>& names, const std::vector<bool>& allowed) {
  const auto& [model, view] = chooser;
  std::size_t best = names.size();
  std::uint64_t highest = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!allowed.empty() && !allowed[i]) continue;
    const std::uint64_t hash = view.empty() ? seeded_hash(seed, purpose, {model, names[i]})
                                            : seeded_hash(seed, purpose, {model, view, names[i]});
    if (best == names.size() || hash > highest) {
      best = i;
      highest = hash;
    }
  }
  DS_ASSERT(best < names.size());
  return best;
}

std::vector<std::size_t> choose_balanced(std::uint64_t seed, std::string_view purpose,
                                         const std::vector<Chooser>& group,
                                         const std::vector<std::string>& names) {
  std::vector<std::tuple<std::uint64_t, std::string, std::string, std::size_t>> order;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto& [model, view] = group[i];
    order.emplace_back(seeded_hash(seed, k_for_order, {purpose, model, view}), model, view, i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> chosen(group.size()), times(names.size(), 0);
  for (const auto& entry : order) {
    const std::size_t at = std::get<3>(entry);
    const std::size_t least = *std::min_element(times.begin(), times.end());
    std::vector<bool> allowed;
    for (const std::size_t count : times)
      allowed.push_back(count == least);
    chosen[at] = highest_hash(seed, purpose, group[at], names, allowed);
    ++times[chosen[at]];
  }
  return chosen;
}

}  // namespace ds

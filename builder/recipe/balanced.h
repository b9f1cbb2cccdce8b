// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What chooses: a model, or a view of one ("" where it is the model).
struct Chooser {
  std::string model, view;
};

/// The candidate of the highest hash, which one more candidate changes for those that then get it.
/// Among those that `allowed` has (as long as `names`, one at least), where it is not empty.
std::size_t highest_hash(std::uint64_t seed, std::string_view purpose, const Chooser& chooser,
                         const std::vector<std::string>& names,
                         const std::vector<bool>& allowed = {});

/// One candidate for each of a group, so that no two candidates are chosen more than once apart: in the
/// order of a hash of their own, each takes, of those chosen least so far, the one of its highest hash. One
/// more in the group changes only those behind it in that order.
std::vector<std::size_t> choose_balanced(std::uint64_t seed, std::string_view purpose,
                                         const std::vector<Chooser>& group,
                                         const std::vector<std::string>& names);

}  // namespace ds

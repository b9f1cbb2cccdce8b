// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/groups.h"

#include <utility>

namespace ds {

void Groups::add(const std::string& cause, const std::string& name, std::string alone) {
  const auto [at, is_new] = index_.try_emplace(cause, groups_.size());
  if (is_new) groups_.push_back({cause, {}, std::move(alone)});
  groups_[at->second].names.push_back(name);
}

void Groups::print(Stream to, bool all_names) const {
  for (const Group& group : groups_) {
    if (group.names.size() == 1) {
      say(to, "{}\n", group.alone);
      continue;
    }
    say(to, "{} and {} more: {}\n", group.names.front(), group.names.size() - 1, group.cause);
    if (!all_names) continue;
    for (const std::string& name : group.names)
      say(to, "  {}\n", name);
  }
}

std::string with_replaced(std::string text, const std::string& own, const std::string& by) {
  for (std::size_t at = text.find(own); at != text.npos; at = text.find(own, at + by.size()))
    text.replace(at, own.size(), by);
  return text;
}

}  // namespace ds

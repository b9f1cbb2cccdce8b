// SPDX-License-Identifier: Apache-2.0
#include "builder/make/earlier_processes.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {

const CrashedImage* EarlierProcesses::crash_of(std::string_view id) const {
  const auto found = std::find_if(crashed.begin(), crashed.end(),
                                  [&](const CrashedImage& image) { return image.id == id; });
  return found != crashed.end() ? &*found : nullptr;
}

const MadeImage* EarlierProcesses::made_of(std::string_view id) const {
  if (made.empty()) return nullptr;
  const auto found = made.find(hash_text(id));
  return found != made.end() ? &found->second : nullptr;
}

std::string to_text(const CrashedImage& image) {
  return fmt::format("the process that made it {}, {} times", image.how, image.times);
}

}  // namespace ds

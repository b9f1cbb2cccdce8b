// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/streams.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace ds {

/// Lines about images or files, of which those with one cause share one.
class Groups {
 public:
  /// `cause`: the same text for all that stand together; `alone`: the line where it is one name.
  void add(const std::string& cause, const std::string& name, std::string alone);
  std::size_t size() const { return groups_.size(); }
  /// "NAME and 7 more: CAUSE", in the order of the first names; below each all its names where they
  /// are wanted.
  void print(Stream to, bool all_names) const;

 private:
  struct Group {
    std::string cause;
    std::vector<std::string> names;
    std::string alone;
  };
  std::map<std::string, std::size_t, std::less<>> index_;
  std::vector<Group> groups_;  ///< in the order of their first names
};

/// The text with `own` replaced by `by` in it: what is said of many, each with its own name, is one
/// cause.
std::string with_replaced(std::string text, const std::string& own, const std::string& by);

}  // namespace ds

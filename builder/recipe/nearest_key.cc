// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/keys.h"
#include "tracer/base/nearest.h"

#include <string_view>
#include <vector>

namespace ds {
namespace {

std::string_view last_part(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

/// The right key in the wrong section, which is nearer than another key of that section: of several,
/// that of the section whose name looks most like it.
std::string_view key_of_other_section(std::string_view unknown) {
  std::string_view found;
  std::size_t least = std::string_view::npos;
  for (const KeySpec& key : recipe_keys()) {
    if (last_part(key.name) != last_part(unknown)) continue;
    const std::size_t distance = edit_distance(unknown, key.name);
    if (distance < least) {
      least = distance;
      found = key.name;
    }
  }
  return found;
}

}  // namespace

std::string_view nearest_key(std::string_view unknown) {
  if (const std::string_view key = key_of_other_section(unknown); !key.empty()) return key;
  std::string_view nearest;
  std::size_t least = 3;  // two slips of the finger
  for (const KeySpec& key : recipe_keys()) {
    const std::size_t distance = edit_distance(unknown, key.name);
    if (distance < least) {
      least = distance;
      nearest = key.name;
    }
  }
  if (!nearest.empty()) return nearest;
  // Without its unit ("fov").
  for (const KeySpec& key : recipe_keys()) {
    const std::string_view own = last_part(unknown), known = last_part(key.name);
    if (own.size() >= 3 && known.starts_with(own) && known[own.size()] == '_') return key.name;
  }
  return {};
}

}  // namespace ds

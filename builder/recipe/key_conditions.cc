// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/keys.h"

namespace ds {

KeyCondition condition_of(const KeySpec& key) {
  const std::string_view text = key.only_with;
  const std::size_t space = text.find(' ');
  const std::size_t literals = text.find("= ") + 2;
  return {text.substr(0, space), text.substr(literals), text[space + 1] != '!'};
}

bool is_choice(std::string_view choices, std::string_view literal) {
  while (!choices.empty()) {
    const std::size_t end = choices.find(" | ");
    if (choices.substr(0, end) == literal) return true;
    choices.remove_prefix(end == choices.npos ? choices.size() : end + 3);
  }
  return false;
}

std::vector<std::string_view> recipe_sections() {
  std::vector<std::string_view> sections;
  for (const KeySpec& key : recipe_keys()) {
    const std::string_view own = key.name.substr(0, key.name.find('.'));
    if (sections.empty() || sections.back() != own) sections.push_back(own);
  }
  return sections;
}

}  // namespace ds

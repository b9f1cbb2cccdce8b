// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/texts.h"

#include "tracer/base/canonical.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace ds {
namespace {

std::optional<Hash128> reference(std::string_view value) {
  if (value.empty() || value.front() != TextSet::k_reference) return std::nullopt;
  return Hash128::from_hex(value.substr(1));
}

/// Calls `visit` with the name and value of each line; both empty where a line is no entry.
template <typename Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, end + 1);
    text.remove_prefix(end + 1);
    visit(line);
  }
}

bool has_long_line(std::string_view text, std::size_t most) {
  bool found = false;
  for_each_line(text, [&](std::string_view line) { found = found || line.size() > most; });
  return found;
}

/// Position of the value in a line, or npos.
std::size_t value_start(std::string_view line) {
  const std::size_t separator = line.find(" = ");
  return separator == std::string_view::npos ? separator : separator + 3;
}

std::string_view value_of(std::string_view line, std::size_t start) {
  std::string_view value = line.substr(start);
  if (!value.empty() && value.back() == '\n') value.remove_suffix(1);
  return value;
}

/// Entries with repeated names told apart ("name", "name #2"), so that each has one partner in
/// another text.
std::vector<std::pair<std::string, std::string>> unique_entries(std::string_view text) {
  auto entries = parse_canonical(text);
  std::map<std::string, int> seen;
  for (auto& [name, value] : entries) {
    const int count = ++seen[name];
    if (count > 1) name += fmt::format(" #{}", count);
  }
  return entries;
}

std::string readable_number(const std::string& token) {
  const std::size_t digits = token.starts_with('-') ? 1 : 0;
  if (token.compare(digits, 2, "0x") != 0 || token.find('p') == std::string::npos) return token;
  char* end = nullptr;
  const double value = std::strtod(token.c_str(), &end);
  if (*end != '\0') return token;
  const float single = static_cast<float>(value);
  return double{single} == value ? fmt::format("{}", single) : fmt::format("{}", value);
}

std::vector<std::string> unescaped_lines(std::string_view value) {
  std::vector<std::string> lines{""};
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value.substr(i, 2) == "\\n") {
      lines.emplace_back();
      ++i;
    } else {
      lines.back() += value[i];
    }
  }
  return lines;
}

}  // namespace

std::string TextSet::fold(std::string_view canonical) {
  if (!has_long_line(canonical, k_longest_value)) return std::string(canonical);
  std::string folded;
  for_each_line(canonical, [&](std::string_view line) {
    const std::size_t start = value_start(line);
    const std::string_view value = start == std::string_view::npos ? "" : value_of(line, start);
    if (value.size() <= k_longest_value) {
      folded += line;
      return;
    }
    const Hash128 hash = hash_text(value);
    texts_.try_emplace(hash, value);
    folded += fmt::format("{}{}{}\n", line.substr(0, start), k_reference, hash.hex());
  });
  return folded;
}

Hash128 TextSet::add(std::string_view canonical) {
  std::string folded = fold(canonical);
  const Hash128 hash = hash_text(folded);
  texts_.try_emplace(hash, std::move(folded));
  return hash;
}

const std::string* TextSet::find(Hash128 hash) const {
  const auto found = texts_.find(hash);
  return found == texts_.end() ? nullptr : &found->second;
}

void TextSet::visit(Hash128 hash,
                    const std::function<void(Hash128, const std::string&)>& visit) const {
  const std::string* text = find(hash);
  if (text == nullptr) return;
  visit(hash, *text);
  for_each_line(*text, [&](std::string_view line) {
    const std::size_t start = value_start(line);
    if (start == std::string_view::npos) return;
    const std::optional<Hash128> inner = reference(value_of(line, start));
    if (!inner) return;
    if (const std::string* value = find(*inner)) visit(*inner, *value);
  });
}

std::string unfold(std::string_view folded, const TextLookup& find) {
  std::string text;
  for_each_line(folded, [&](std::string_view line) {
    const std::size_t start = value_start(line);
    std::optional<Hash128> inner;
    if (start != std::string_view::npos) inner = reference(value_of(line, start));
    const std::optional<std::string> value = inner ? find(*inner) : std::nullopt;
    text += value ? fmt::format("{}{}\n", line.substr(0, start), *value) : std::string(line);
  });
  return text;
}

std::vector<PropertyChange> diff_texts(std::string_view before, std::string_view after) {
  const auto old_entries = unique_entries(before);
  const auto new_entries = unique_entries(after);
  const std::map<std::string, std::string> old_values(old_entries.begin(), old_entries.end());
  std::set<std::string> common;
  std::vector<PropertyChange> changes;
  for (const auto& [name, value] : new_entries) {
    const auto old = old_values.find(name);
    if (old == old_values.end()) {
      changes.push_back({name, std::nullopt, value});
      continue;
    }
    common.insert(name);
    if (old->second != value) changes.push_back({name, old->second, value});
  }
  for (const auto& [name, value] : old_entries)
    if (!common.contains(name)) changes.push_back({name, value, std::nullopt});
  return changes;
}

std::string readable_value(std::string_view value) {
  std::string readable;
  while (true) {
    const std::size_t space = value.find(' ');
    readable += readable_number(std::string(value.substr(0, space)));
    if (space == std::string_view::npos) return readable;
    readable += ' ';
    value.remove_prefix(space + 1);
  }
}

std::string to_string(const PropertyChange& change) {
  const auto is_long = [](const std::optional<std::string>& value) {
    return value && (value->size() > TextSet::k_longest_value || reference(*value));
  };
  if (is_long(change.before) || is_long(change.after)) return change.name + ": differs";
  if (!change.before)
    return fmt::format("{}: added {}", change.name, readable_value(*change.after));
  if (!change.after)
    return fmt::format("{}: removed (was {})", change.name, readable_value(*change.before));
  return fmt::format("{}: {} -> {}", change.name, readable_value(*change.before),
                     readable_value(*change.after));
}

std::vector<std::string> diff_lines(std::string_view before, std::string_view after,
                                    std::size_t most) {
  const std::vector<std::string> old_lines = unescaped_lines(before);
  const std::vector<std::string> new_lines = unescaped_lines(after);
  // Common head and tail are left out. What is between may hold equal lines too; an edit is rarely
  // in two far places.
  const auto [old_head, new_head] =
      std::mismatch(old_lines.begin(), old_lines.end(), new_lines.begin(), new_lines.end());
  auto old_tail = old_lines.end();
  auto new_tail = new_lines.end();
  while (old_tail != old_head && new_tail != new_head && *(old_tail - 1) == *(new_tail - 1))
    --old_tail, --new_tail;
  std::vector<std::string> lines;
  for (auto line = old_head; line != old_tail; ++line)
    lines.push_back("- " + *line);
  for (auto line = new_head; line != new_tail; ++line)
    lines.push_back("+ " + *line);
  if (lines.size() > most) {
    const std::size_t left_out = lines.size() - most;
    lines.resize(most);
    lines.push_back(fmt::format("... {} more lines", left_out));
  }
  return lines;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace ds {
namespace {

/// More than these are no help in one message.
constexpr std::size_t k_most_listed = 40;

bool same_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

std::string_view only_one_begun(std::string_view word,
                                std::span<const std::string_view> candidates) {
  constexpr std::size_t k_least = 3;
  if (word.size() < k_least) return {};
  const auto begun = [&](std::string_view candidate) { return candidate.starts_with(word); };
  const auto first = std::find_if(candidates.begin(), candidates.end(), begun);
  if (first == candidates.end() || std::any_of(first + 1, candidates.end(), begun)) return {};
  return *first;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  const auto same = std::find_if(candidates.begin(), candidates.end(),
                                 [&](std::string_view c) { return same_but_for_case(word, c); });
  if (same != candidates.end()) return *same;
  std::string_view best;
  std::size_t least = word.size() <= 2   ? 1
                      : word.size() <= 4 ? 2
                                         : 3;  // a distance below it counts
  for (const std::string_view candidate : candidates) {
    if (std::max(candidate.size(), word.size()) - std::min(candidate.size(), word.size()) >= least)
      continue;
    const std::size_t distance = edit_distance(word, candidate);
    // A word of which nothing is left is no misspelling.
    if (distance >= least || distance >= std::min(word.size(), candidate.size())) continue;
    least = distance;
    best = candidate;
  }
  return best.empty() ? only_one_begun(word, candidates) : best;
}

std::string_view nearest(std::string_view word, const std::vector<std::string>& candidates) {
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  return nearest(word, views);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view found = nearest(word, candidates);
  return found.empty() ? "" : fmt::format(", did you mean {}?", found);
}

std::string similar_name(const std::filesystem::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  if (std::filesystem::exists(path, error)) return "";  // there, and not what it should be
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::vector<std::string_view> views(names.begin(), names.end());
  return did_you_mean(path.filename().string(), views);
}

std::string known_words(std::string_view word, std::span<const std::string_view> candidates) {
  std::string text = did_you_mean(word, candidates);
  if (!text.empty() || candidates.empty() || candidates.size() > k_most_listed) return text;
  return fmt::format("; there {} {}", candidates.size() == 1 ? "is" : "are",
                     fmt::join(candidates, ", "));
}

}  // namespace ds

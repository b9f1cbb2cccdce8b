// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/check.h"

#include "manifests/check/check_list.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace ds {

#define DS_DECLARE_CHECK(NAME) Check NAME##_check();
DS_ALL_CHECKS(DS_DECLARE_CHECK)

std::string_view name_of(CheckLevel level) {
  switch (level) {
    case CheckLevel::note:
      return "note";
    case CheckLevel::warning:
      return "warning";
    case CheckLevel::error:
      return "error";
  }
  assertion_failed("a CheckLevel", __FILE__, __LINE__);
}

namespace {

/// "random" of a line "materials.assign = random"; "" without such a line.
std::string value_in(const std::string& text, std::string_view key) {
  const std::string line = fmt::format("{} = ", key);
  const std::size_t at = text.starts_with(line) ? 0 : text.find("\n" + line);
  if (at == text.npos) return "";
  const std::size_t from = at + line.size() + (at == 0 && text.starts_with(line) ? 0 : 1);
  return text.substr(from, text.find('\n', from) - from);
}

}  // namespace

std::string CheckInput::setting(std::string_view key) const {
  return value_in(dataset.recipe_text, key);
}

double CheckInput::threshold(const Threshold& threshold) const {
  const std::string text = value_in(recipe_now ? *recipe_now : dataset.recipe_text,
                                    fmt::format("check.{}", threshold.name));
  double value = threshold.standard;
  const char* const end = text.data() + text.size();
  if (std::from_chars(text.data(), end, value).ptr != end || !threshold.range.contains(value))
    return threshold.standard;
  return value;
}

void CheckReport::add(CheckLevel level, std::string what, const std::vector<std::string>& found,
                      std::uint64_t of, std::string advice,
                      std::optional<std::vector<std::string>> images) {
  if (found.empty()) return;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(found.size(), k_check_examples));
  findings_.push_back({check_,
                       level,
                       std::move(what),
                       found.size(),
                       of,
                       {found.begin(), found.begin() + shown},
                       std::move(advice),
                       images.value_or(found)});
}

void CheckReport::say(CheckLevel level, std::string what, std::string advice) {
  findings_.push_back({check_, level, std::move(what), 0, 0, {}, std::move(advice), {}});
}

std::span<const Check> checks() {
#define DS_CHECK_ROW(NAME) NAME##_check(),
  static const std::vector<Check> rows = {DS_ALL_CHECKS(DS_CHECK_ROW)};
  return rows;
}

std::vector<CheckFinding> worst_first(std::vector<CheckFinding> findings) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const auto& a, const auto& b) { return a.level > b.level; });
  return findings;
}

bool any_reads_pictures(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    const auto all = checks();
    return std::any_of(all.begin(), all.end(), [&](const Check& check) {
      return check.reads_pictures && check.name == name;
    });
  });
}

std::vector<CheckFinding> run_checks(const CheckInput& input,
                                     const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const Check& check : checks())
    known.emplace_back(check.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      fail(ErrorKind::usage, "--only: wanted {}, got {}{}",
           fmt::format("{}", fmt::join(known, ", ")), name, did_you_mean(name, known));
  std::vector<CheckFinding> findings;
  for (const Check& check : checks()) {
    if (!names.empty() && std::find(names.begin(), names.end(), check.name) == names.end())
      continue;
    if (check.reads_pictures && input.files.pictures.empty()) continue;
    CheckReport report(check.name);
    check.run(input, report);
    std::vector<CheckFinding> found = std::move(report).take();
    std::move(found.begin(), found.end(), std::back_inserter(findings));
  }
  return findings;
}

nlohmann::json to_json_value(const CheckFinding& finding) {
  return {{"check", finding.check},  {"level", name_of(finding.level)},
          {"what", finding.what},    {"count", finding.count},
          {"of", finding.of},        {"examples", finding.examples},
          {"advice", finding.advice}};
}

}  // namespace ds

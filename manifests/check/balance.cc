// SPDX-License-Identifier: Apache-2.0
// Classes of very different numbers of models or images, and of one split only.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {
namespace {

/// As Datumaro's validator has it.
constexpr Threshold k_balance_ratio{
    "balance_ratio",
    50,
    {.least = 1},
    "How many times as many images as the smallest the largest class may have"};

void check_parts(const CheckInput& input, CheckReport& report, const Division& division) {
  std::map<std::string, std::set<std::string>> parts;  // of each class
  for (const ImageRecord& image : input.images)
    if (auto part = division.part_of(image); part && !image.class_path.empty())
      parts[image.class_path].insert(*std::move(part));
  std::set<std::string> all;
  for (const auto& [path, of] : parts)
    all.insert(of.begin(), of.end());
  if (all.size() < 2) return;
  std::vector<std::string> single;
  for (const auto& [path, of] : parts)
    if (of.size() == 1) single.push_back(name_in(path, *of.begin()));
  report.add(CheckLevel::error, fmt::format("classes have images in one {} only", division.one),
             single, parts.size(), "they cannot be learned and tested both",
             ids_where(input.images, [&](const ImageRecord& image) {
               return division.part_of(image) && !image.class_path.empty() &&
                      parts.at(image.class_path).size() == 1;
             }));
}

void check_balance(const CheckInput& input, CheckReport& report) {
  if (input.images.empty()) {
    report.say(CheckLevel::error, "the dataset has no images");
    return;
  }
  std::map<std::string, std::uint64_t> counts;
  std::map<std::string, std::set<std::string>> models;
  for (const ImageRecord& image : input.images) {
    if (image.class_path.empty()) continue;
    ++counts[image.class_path];
    models[image.class_path].insert(image.model);
  }
  if (counts.empty()) {
    report.say(CheckLevel::note, "the dataset has no classes",
               "classes.train and classes.test name class files");
    return;
  }
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end(), less);
  const double ratio = static_cast<double>(most->second) / static_cast<double>(least->second);
  if (ratio > input.threshold(k_balance_ratio))
    report.say(CheckLevel::warning,
               fmt::format(
                   "{} has {} images and {} has {}, {:.0f} times as many: a classifier that always "
                   "says {} looks good",
                   least->first, least->second, most->first, most->second, ratio, most->first),
               "models.files or class files with fewer of it; or weights in training");
  // Where classes are split, each is meant to be in one alone.
  if (split_by(input) != "class")
    for (const Division& division : divisions_of(input.images))
      check_parts(input, report, division);
  std::vector<std::string> lonely;
  for (const auto& [path, of] : models)
    if (of.size() == 1) lonely.push_back(path);
  report.add(CheckLevel::warning, "classes have a single model: it is learned by heart", lonely,
             models.size(), "", ids_where(input.images, [&](const ImageRecord& image) {
               return !image.class_path.empty() && models.at(image.class_path).size() == 1;
             }));
}

}  // namespace

Check balance_check() {
  return {"balance",
          "classes of one split or fold, of one model, or far larger than others",
          check_balance,
          {k_balance_ratio}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Classes of very different numbers of models or images, and of one split only.
#include "manifests/check/check.h"
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

void check_balance(const CheckInput& input, CheckReport& report) {
  if (input.images.empty()) {
    report.say(CheckLevel::error, "the dataset has no images");
    return;
  }
  std::map<std::string, std::map<std::string, std::uint64_t>> counts;  // class, split
  std::map<std::string, std::set<std::string>> models;
  std::set<std::string> splits;
  for (const ImageRecord& image : input.images) {
    if (image.class_path.empty()) continue;
    ++counts[image.class_path][image.split];
    models[image.class_path].insert(image.model);
    splits.insert(image.split);
  }
  if (counts.empty()) {
    report.say(CheckLevel::note, "the dataset has no classes",
               "classes.train and classes.test name class files");
    return;
  }
  const auto size = [](const auto& entry) {
    std::uint64_t sum = 0;
    for (const auto& [split, count] : entry.second)
      sum += count;
    return sum;
  };
  const auto less = [&](const auto& a, const auto& b) { return size(a) < size(b); };
  const auto [least, most] = std::minmax_element(counts.begin(), counts.end(), less);
  const double ratio = static_cast<double>(size(*most)) / static_cast<double>(size(*least));
  if (ratio > input.threshold(k_balance_ratio))
    report.say(CheckLevel::warning,
               fmt::format(
                   "{} has {} images and {} has {}, {:.0f} times as many: a classifier that always "
                   "says {} looks good",
                   least->first, size(*least), most->first, size(*most), ratio, most->first),
               "models.files or class files with fewer of it; or weights in training");
  std::vector<std::string> lonely, single;
  for (const auto& [path, by_split] : counts)
    if (splits.size() > 1 && by_split.size() == 1)
      single.push_back(fmt::format("{} ({})", path, by_split.begin()->first));
  for (const auto& [path, of] : models)
    if (of.size() == 1) lonely.push_back(path);
  const auto of_classes = [&](const auto& is) {
    return ids_where(input.images, [&](const ImageRecord& image) {
      return !image.class_path.empty() && is(image.class_path);
    });
  };
  report.add(CheckLevel::error, "classes have images in one split only", single, counts.size(),
             "they cannot be learned and tested both",
             of_classes([&](const std::string& path) { return counts.at(path).size() == 1; }));
  report.add(CheckLevel::warning, "classes have a single model: it is learned by heart", lonely,
             models.size(), "",
             of_classes([&](const std::string& path) { return models.at(path).size() == 1; }));
}

}  // namespace

Check balance_check() {
  return {"balance",
          "classes of one split, of one model, or far larger than others",
          check_balance,
          {k_balance_ratio}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/check.h"

#include "builder/cmd/grammar.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <filesystem>

namespace ds {
namespace {

nlohmann::json to_json(const std::vector<CheckFinding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const CheckFinding& finding : findings)
    list.push_back(to_json_value(finding));
  return list;
}

void print(const CheckFinding& finding) {
  std::string text = fmt::format("{}: {}: ", name_of(finding.level), finding.check);
  if (finding.of > 0) text += fmt::format("{} of {} ", finding.count, finding.of);
  text += finding.of > 0 ? agreeing(finding.count, finding.what) : finding.what;
  if (!finding.examples.empty()) text += fmt::format(": {}", fmt::join(finding.examples, ", "));
  if (finding.count > finding.examples.size())
    text += fmt::format(" and {} more", finding.count - finding.examples.size());
  if (!finding.advice.empty()) text += fmt::format(" ({})", finding.advice);
  say(Stream::result, "{}\n", text);
}

}  // namespace

int run_check(const Arguments& arguments) {
  const std::filesystem::path folder = dataset_folder(arguments.request());
  const CheckInput input{read_dataset_manifest(folder), read_images_manifest(folder)};
  const std::vector<CheckFinding> findings = worst_first(run_checks(input, arguments.only));
  const auto count = [&](CheckLevel level) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const CheckFinding& finding) { return finding.level == level; });
  };
  const auto errors = count(CheckLevel::error), warnings = count(CheckLevel::warning);
  if (arguments.json) {
    print_json({{"images", input.images.size()},
                {"errors", errors},
                {"warnings", warnings},
                {"findings", to_json(findings)}});
  } else {
    for (const CheckFinding& finding : findings)
      print(finding);
    say(Stream::result, "{} images checked: {} error{}, {} warning{}\n", input.images.size(),
        errors, errors == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s");
  }
  return errors + warnings > 0 ? 1 : 0;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/check.h"

#include "builder/cmd/grammar.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <filesystem>
#include <functional>

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

template <typename Facts>
std::size_t known(const std::vector<std::optional<Facts>>& facts) {
  return static_cast<std::size_t>(
      std::count_if(facts.begin(), facts.end(), [](const auto& one) { return one.has_value(); }));
}

/// What the checks of files had to look at: nothing is found where nothing is there.
std::string files_text(const CheckInput& input) {
  const std::size_t pictures = known(input.files.pictures), depths = known(input.files.depths);
  std::string text =
      fmt::format("; of {} the picture was read, of {} depth and mask", pictures, depths);
  if (depths == 0) text += " (depths wants outputs.planes mask and depth)";
  return text;
}

}  // namespace

int run_check(const Arguments& arguments) {
  const std::filesystem::path folder = dataset_folder(arguments.request());
  CheckInput input{read_dataset_manifest(folder), read_images_manifest(folder)};
  if (std::error_code error; !std::filesystem::is_directory(arguments.target, error)) {
    std::string& settings = input.recipe_now.emplace();
    for (const auto& [key, value] : read_recipe(arguments.target, arguments.overrides).settings)
      settings += fmt::format("{} = {}\n", key, value);
  }
  std::uint64_t unreadable = 0;
  const bool pictures = arguments.pictures || any_reads_pictures(arguments.only);
  if (pictures) {
    WorkProgress progress("pictures read");
    input.files = read_file_facts(
        folder, input.images,
        [&](const std::string& why) {
          ++unreadable;
          warn(why);
        },
        std::ref(progress));
  }
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
                {"pictures_read", pictures},
                {"pictures", known(input.files.pictures)},
                {"depths", known(input.files.depths)},
                {"unreadable", unreadable},
                {"findings", to_json(findings)}});
  } else {
    for (const CheckFinding& finding : findings)
      print(finding);
    say(Stream::result, "{} images checked: {} error{}, {} warning{}{}\n", input.images.size(),
        errors, errors == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s",
        pictures ? files_text(input) : "; --pictures reads the pictures, too");
    if (unreadable > 0)
      say(Stream::result, "of {} images the files could not be read\n", unreadable);
  }
  return errors + warnings + static_cast<std::ptrdiff_t>(unreadable) > 0 ? 1 : 0;
}

}  // namespace ds

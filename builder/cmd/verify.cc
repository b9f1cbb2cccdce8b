// SPDX-License-Identifier: Apache-2.0
#include "builder/build/verify.h"

#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/streams.h"

#include <filesystem>

namespace ds {
namespace {

/// A dataset's folder that was copied without its database can be checked for what its manifest
/// says.
bool is_bare_folder(const Arguments& arguments) {
  return std::filesystem::is_directory(arguments.target) && !enclosing_dataset(arguments.target);
}

void verify_dataset(VerifyResult& result, const Arguments& arguments) {
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  // Bytes are looked at, of outputs and inputs alike: stamps are what the other verbs go by.
  Inputs inputs(*dataset.database, Stamps::ignore);
  const Plan plan = make_plan(dataset, inputs, false);
  verify_against_plan(result, dataset, plan);
  if (arguments.rerender == 0) return;
  TracerOptions options;
  options.device = arguments.device;
  const auto renderer = make_tracer_renderer(inputs, dataset.recipe, options);
  const auto told = [](const std::string& id) { say(Stream::people, "tracing {} again\n", id); };
  verify_by_tracing(result, dataset, plan, inputs, *renderer, arguments.rerender, arguments.seed,
                    told, stop_on_signal());
}

void print_findings(const VerifyResult& result) {
  for (const Finding& finding : result.findings)
    say(Stream::result, "{}: {}: {}\n", to_string(finding.kind), finding.path, finding.what);
  say(Stream::result, "{} images, {} files: ", result.images, result.files);
  if (result.rerendered > 0) say(Stream::result, "{} images traced again: ", result.rerendered);
  if (result.findings.empty())
    say(Stream::result, "all as the manifest says\n");
  else
    say(Stream::result, "{} differences\n", result.findings.size());
}

}  // namespace

int run_verify(const Arguments& arguments) {
  const bool bare = is_bare_folder(arguments);
  if (bare && arguments.rerender > 0)
    fail(ErrorKind::usage,
         "{}: --rerender needs the recipe; the folder has no database that names it",
         arguments.target);
  VerifyResult result = verify_files(dataset_folder(arguments.request()));
  if (!bare) verify_dataset(result, arguments);
  if (arguments.json) {
    nlohmann::json findings = nlohmann::json::array();
    for (const Finding& finding : result.findings)
      findings.push_back(
          {{"kind", to_string(finding.kind)}, {"path", finding.path}, {"what", finding.what}});
    print_json({{"images", result.images},
                {"files", result.files},
                {"rerendered", result.rerendered},
                {"differences", result.findings.size()},
                {"findings", findings}});
  } else {
    print_findings(result);
  }
  return result.findings.empty() ? 0 : 1;
}

}  // namespace ds

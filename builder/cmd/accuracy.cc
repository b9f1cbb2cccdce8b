// SPDX-License-Identifier: Apache-2.0
#include "builder/measure/accuracy.h"

#include "builder/cmd/forecast_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/page/csv.h"
#include "builder/page/page.h"
#include "builder/store/input_folders.h"
#include "tracer/base/files.h"
#include "tracer/base/streams.h"

#include <filesystem>

namespace ds {
namespace {

namespace fs = std::filesystem;

Against against_of(const std::string& name) {
  if (name == "spp") return Against::spp;
  return name == "minutes" ? Against::minutes : Against::both;
}

nlohmann::json to_json(const PairAccuracy& pair) {
  nlohmann::json object{{"environment", pair.environment},
                        {"material", pair.material},
                        {"image", pair.image},
                        {"images", pair.images}};
  if (pair.law) object["slope"] = interval_json(pair.law->line.slope_interval());
  if (!pair.no_targets.empty()) object["no_targets"] = pair.no_targets;
  object["targets"] = nlohmann::json::array();
  for (const Target& target : pair.targets)
    object["targets"].push_back({{"error", target.error},
                                 {"spp", interval_json(target.spp)},
                                 {"seconds", interval_json(target.seconds)},
                                 {"extrapolated", target.extrapolated}});
  return object;
}

void print(const Accuracy& accuracy, const fs::path& report, const fs::path& csv,
           const Arguments& arguments) {
  if (!arguments.json) {
    say(Stream::result, "report: {}\nnumbers: {}\n", report.string(), csv.string());
    return;
  }
  nlohmann::json pairs = nlohmann::json::array();
  for (const PairAccuracy& pair : accuracy.pairs)
    pairs.push_back(to_json(pair));
  print_json({{"report", report.string()},
              {"csv", csv.string()},
              {"device", accuracy.device},
              {"most_spp", accuracy.options.most_spp},
              {"pairs", pairs}});
}

}  // namespace

int run_accuracy(const Arguments& arguments) {
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::inputs, disk);
  if (!dataset.recipe.outputs.image)
    fail(ErrorKind::usage,
         "{}: wanted a recipe whose pictures are traced, found outputs.image = false; measure it "
         "with --set outputs.image=true",
         arguments.target);
  const fs::path report = arguments.report_file.empty()
                              ? fs::path(dataset.recipe.name + "-accuracy.html")
                              : fs::path(arguments.report_file);
  fs::path csv_file = report;
  csv_file.replace_extension(".csv");
  if (csv_file == report)
    fail(ErrorKind::usage, "-o {}: wanted the name of a page, found that of its numbers",
         report.string());
  // Said now, not when everything is measured.
  for (const fs::path& file : {report, csv_file})
    if (std::error_code error; fs::is_directory(file, error))
      fail(ErrorKind::usage, "-o {}: wanted the name of a page, found the folder {}",
           report.string(), file.string());
  for (const fs::path& file : {report, csv_file})
    check_no_input_file(file, "-o", dataset.recipe);
  Inputs inputs(*dataset.database);
  TracerOptions options;
  options.device = arguments.device;
  const auto tracer = make_scene_tracer(options);
  const auto told = [](const std::string& what) { say(Stream::people, "{}\n", what); };
  const Accuracy accuracy = measure_accuracy(
      dataset.recipe, inputs, *tracer,
      {arguments.most_spp, arguments.seeds, 8, !arguments.no_choices}, told, stop_on_signal());
  const std::string csv = accuracy_csv(accuracy);
  disk.write(csv_file, bytes_of(csv));
  disk.write(report, bytes_of(accuracy_page(accuracy, against_of(arguments.against), csv,
                                            csv_file.filename().string())));
  print(accuracy, report, csv_file, arguments);
  return 0;
}

}  // namespace ds

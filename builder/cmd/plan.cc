// SPDX-License-Identifier: Apache-2.0
#include "builder/build/plan.h"

#include "builder/cmd/forecast_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "tracer/device/program_cache.h"

#include <cstdio>
#include <unistd.h>

namespace ds {
namespace {

nlohmann::json plan_json(const Plan& plan, const PlanCounts& counts) {
  nlohmann::json object = to_json(counts);
  object["remove_files"] = plan.to_remove;
  object["stale_images"] = nlohmann::json::array();
  object["failed_images"] = nlohmann::json::array();
  for (const PlannedImage& image : plan.images) {
    if (image.error)
      object["failed_images"].push_back({{"id", image.spec.id}, {"why", image.error->what()}});
    if (image.stale())
      object["stale_images"].push_back(
          {{"id", image.spec.id}, {"step", step_of(image)}, {"reasons", image.reasons}});
  }
  return object;
}

/// What is to be foretold.
struct Wish {
  bool any = false;
  std::optional<double> error, budget_seconds;

  /// Another error is another picture: everything is made.
  bool all_images() const { return error || budget_seconds; }
};

Wish wish_of(const Arguments& arguments) {
  Wish wish;
  wish.any = arguments.time || arguments.error || !arguments.budget.empty();
  if (int{arguments.time} + int{arguments.error.has_value()} + int{!arguments.budget.empty()} > 1)
    fail(ErrorKind::usage, "--time, --error and --budget are three questions: ask one");
  if (!wish.any && arguments.recalibrate)
    fail(ErrorKind::usage, "--recalibrate needs --time, --error or --budget");
  wish.error = arguments.error;
  if (arguments.budget.empty()) return wish;
  wish.budget_seconds = parse_duration(arguments.budget);
  if (!wish.budget_seconds)
    fail(ErrorKind::usage, "--budget: wanted a duration such as 8h, 90m or 1h30m, got {}",
         arguments.budget);
  return wish;
}

Calibration calibration_of(const Arguments& arguments, const Dataset& dataset, Inputs& inputs,
                           bool by_error) {
  TracerOptions options;
  options.device = arguments.device;
  const auto renderer = make_tracer_renderer(inputs, dataset.recipe, options);
  const std::filesystem::path cache = default_cache_folder();
  const auto told = [](const std::string& what) { fmt::print(stderr, "{}\n", what); };
  return calibrate(
      dataset.recipe, inputs, *renderer, CalibrationCache(cache), {arguments.recalibrate, by_error},
      cache / fmt::format("calibrating-{}", ::getpid()), {told, wall_clock, stop_on_signal()});
}

/// What was asked, as a sentence, and the forecast that answers it; none where no error fits into
/// the budget.
struct Answer {
  std::string sentence;
  std::optional<Interval> error;
  std::optional<Forecast> forecast;
};

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

Answer answer(const Wish& wish, const Recipe& recipe, const std::vector<ProbedWork>& work) {
  if (!recipe.outputs.image)
    return {"no samples, as outputs.image = false", {}, forecast(work, {std::nullopt, 0})};
  if (wish.budget_seconds) {
    const std::optional<Interval> error = error_for(work, *wish.budget_seconds);
    if (!error)
      return {"no error can be had for this budget: the least samples take longer", {}, {}};
    return {fmt::format("the budget buys an error of {} ({} to {})", percent(error->value),
                        percent(error->low), percent(error->high)),
            error, forecast(work, {error->value, 0})};
  }
  Samples samples{wish.error, recipe.engine.spp};
  const std::optional<ErrorTarget>& target = recipe.engine.target;
  if (target) {
    samples.error = samples.error.value_or(target->error);
    samples.most_spp = target->max_spp;
  }
  return {samples.error ? fmt::format("every picture to an error of {} (engine.error)",
                                      percent(*samples.error))
                        : fmt::format("{} samples a pixel", recipe.engine.spp),
          std::nullopt, forecast(work, samples)};
}

nlohmann::json answer_json(const Answer& answer, const Calibration& calibration) {
  nlohmann::json object{{"device", calibration.device}, {"measured", calibration.measured}};
  if (answer.forecast) object.update(to_json(*answer.forecast));
  if (answer.error)
    object["error"] = {
        {"value", answer.error->value}, {"low", answer.error->low}, {"high", answer.error->high}};
  return object;
}

void print_answer(const Answer& answer, const Calibration& calibration) {
  fmt::print("{}, on {}\n", answer.sentence, calibration.device);
  if (!answer.forecast) return;
  fmt::print("time {}\ndisk {}\n\n{}", time_text(answer.forecast->seconds),
             size_text(answer.forecast->bytes), pairs_text(*answer.forecast));
}

}  // namespace

int run_plan(const Arguments& arguments) {
  const Wish wish = wish_of(arguments);
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  if (wish.all_images() && !dataset.recipe.outputs.image)
    fail(ErrorKind::usage,
         "{} is of pictures, and with outputs.image = false the recipe makes none; ask --time",
         wish.error ? "--error" : "--budget");
  Inputs inputs(*dataset.database);
  const Plan plan = make_plan(dataset, inputs, wish.all_images());
  const PlanCounts counts = count(plan);
  nlohmann::json object = arguments.json ? plan_json(plan, counts) : nlohmann::json();
  if (!arguments.json) {
    if (!wish.any) print_plan(stdout, plan);
    fmt::print("{}\n", summary(counts));
  }
  bool answered = true;
  if (wish.any) {
    const Calibration calibration = calibration_of(
        arguments, dataset, inputs, wish.all_images() || dataset.recipe.engine.target);
    const Answer found =
        answer(wish, dataset.recipe, join(work_of(plan, dataset.recipe), calibration));
    answered = found.forecast.has_value();
    if (arguments.json)
      object["forecast"] = answer_json(found, calibration);
    else
      print_answer(found, calibration);
  }
  if (arguments.json) print_json(object);
  return counts.failed > 0 || !answered ? 1 : 0;
}

}  // namespace ds

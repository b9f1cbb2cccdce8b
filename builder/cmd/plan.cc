// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/plan.h"

#include "builder/cmd/concerns_text.h"
#include "builder/cmd/draws_text.h"
#include "builder/cmd/forecast_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/forecast/budget.h"
#include "tracer/base/process_folder.h"
#include "tracer/base/streams.h"
#include "tracer/device/program_cache.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ds {
namespace {

nlohmann::json plan_json(const Plan& plan, const PlanCounts& counts) {
  nlohmann::json object = to_json(counts);
  object["manifest"] = to_json(plan.manifest);
  object["remove_files"] = plan.to_remove;
  object["edited_files"] = plan.edited;
  object["stale_images"] = nlohmann::json::array();
  object["failed_images"] = nlohmann::json::array();
  for (const PlannedImage& image : plan.images) {
    if (image.elsewhere) continue;
    if (image.error)
      object["failed_images"].push_back({{"id", image.spec.id}, {"why", image.error->what()}});
    if (image.stale())
      object["stale_images"].push_back(
          {{"id", image.spec.id}, {"step", step_of(image)}, {"reasons", image.reasons}});
  }
  return object;
}

/// What is to be forecast.
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
  const auto told = [](const std::string& what) { say(Stream::people, "{}\n", what); };
  return calibrate(dataset.recipe, inputs, *renderer, CalibrationCache(cache),
                   {arguments.recalibrate, by_error}, make_process_folder(cache / "calibrating"),
                   {told, wall_clock, stop_on_signal()});
}

/// A larger engine.max_spp, and the error that the budget buys with it.
struct MoreSamples {
  int max_spp = 0;
  double error = 0;
};

/// What was asked, as a sentence, and the forecast that answers it; none where no error fits into
/// the budget.
struct Answer {
  std::string sentence;
  std::optional<Bought> bought{};
  std::optional<MoreSamples> more{};  ///< where engine.max_spp keeps the budget from buying it
  std::optional<Forecast> forecast{};
};

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

/// engine.max_spp; its default where the recipe has a number of samples instead of an error.
int max_spp_of(const Recipe& recipe) {
  return recipe.engine.target.value_or(ErrorTarget{}).max_spp;
}

Answer answer_budget(double seconds, int max_spp, const std::vector<ProbedWork>& work) {
  const std::optional<Bought> bought = error_for(work, seconds, max_spp);
  if (!bought) return {"no engine.error can be had for this budget: the least samples take longer"};
  const Interval& error = bought->error;
  Answer answer{fmt::format("the budget buys an engine.error of {} ({} to {})",
                            percent(error.value), percent(error.low), percent(error.high)),
                bought};
  answer.forecast = forecast(work, {error.value, 0, double(max_spp)});
  if (!bought->capped) return answer;
  answer.sentence += fmt::format(", the least with engine.max_spp = {}", max_spp);
  const std::optional<Bought> most = error_for(work, seconds, k_most_spp);
  if (!most || most->error.value >= error.value) return answer;
  // A power of two at least: what is forecast of single pictures is not exact.
  const double needed = std::min(most_spp_for(work, most->error.value), k_most_spp);
  const auto rounded = std::bit_ceil(static_cast<unsigned>(std::ceil(needed)));
  answer.more = {static_cast<int>(rounded), most->error.value};
  answer.sentence +=
      fmt::format(" ({} would buy {})", answer.more->max_spp, percent(answer.more->error));
  return answer;
}

Answer answer(const Wish& wish, const Recipe& recipe, const std::vector<ProbedWork>& work) {
  const auto answered = [&](std::string sentence, const Samples& samples) {
    Answer answer{std::move(sentence)};
    answer.forecast = forecast(work, samples);
    return answer;
  };
  if (!recipe.outputs.image)
    return answered("no samples, as outputs.image = false", {std::nullopt, 0});
  const int max_spp = max_spp_of(recipe);
  if (wish.budget_seconds) return answer_budget(*wish.budget_seconds, max_spp, work);
  if (!wish.error && !recipe.engine.target)
    return answered(fmt::format("{} samples a pixel", recipe.engine.spp),
                    {std::nullopt, recipe.engine.spp});
  const double error = wish.error ? *wish.error : recipe.engine.target->error;
  return answered(fmt::format("every picture to an engine.error of {}, with at most {} "
                              "samples a pixel (engine.max_spp)",
                              percent(error), max_spp),
                  {error, 0, double(max_spp)});
}

bool is_work(const PairWork& pair) {
  return pair.trace > 0 || pair.remake > 0;
}

nlohmann::json answer_json(const Answer& answer, const Calibration& calibration) {
  nlohmann::json object{{"device", calibration.device}, {"measured", calibration.measured}};
  if (answer.forecast) object.update(to_json(*answer.forecast));
  if (answer.bought) {
    object["engine_error"] = interval_json(answer.bought->error);
    object["capped"] = answer.bought->capped;
  }
  if (answer.more)
    object["more"] = {{"max_spp", answer.more->max_spp}, {"engine_error", answer.more->error}};
  return object;
}

void print_answer(const Answer& answer, const Calibration& calibration) {
  say(Stream::result, "{}{}{}\n", answer.sentence, calibration.device.empty() ? "" : ", on ",
      calibration.device);
  if (!answer.forecast || calibration.device.empty()) return;
  say(Stream::result, "time {}\ndisk {}\n\n{}", time_text(answer.forecast->seconds),
      size_text(answer.forecast->bytes), pairs_text(*answer.forecast));
}

}  // namespace

int run_plan(const Arguments& arguments) {
  const Wish wish = wish_of(arguments);
  const Shard shard = shard_of(arguments);
  RealDisk disk;
  Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
  if (wish.all_images() && !dataset.recipe.outputs.image)
    fail(ErrorKind::usage,
         "{} is of pictures, and with outputs.image = false the recipe makes none; ask --time",
         wish.error ? "--error" : "--budget");
  Inputs inputs(*dataset.database, stamps_of(arguments));
  const Plan plan = make_plan(dataset, inputs, wish.all_images(), shard);
  const PlanCounts counts = count(plan);
  const std::vector<Concern> concerns = tell_planned_concerns(dataset.recipe, plan);
  nlohmann::json object = arguments.json ? plan_json(plan, counts) : nlohmann::json();
  if (arguments.json) object["concerns"] = to_json(concerns);
  if (arguments.json && dataset.recipe.keep.any()) object["keep"] = rejected_json(plan.drawn);
  if (arguments.json && arguments.draws) object.update(draws_json(dataset.recipe, plan));
  if (!arguments.json) {
    if (arguments.draws)
      print_draws(dataset.recipe, plan, arguments.verbose);
    else if (!wish.any)
      print_plan(Stream::result, plan, arguments.verbose);
    say(Stream::result, "{}\n", summary(counts));
    print_rejected(dataset.recipe, plan.drawn);
    print_manifest_line(plan);
    print_edited(plan);
  }
  bool answered = true;
  if (wish.any) {
    const std::vector<PairWork> work = work_of(plan, dataset.recipe);
    Calibration calibration;
    Answer found{"nothing to make, so no time was measured", {}, {}, Forecast{}};
    if (wish.all_images() || std::any_of(work.begin(), work.end(), is_work)) {
      calibration = calibration_of(arguments, dataset, inputs,
                                   wish.all_images() || dataset.recipe.engine.target);
      found = answer(wish, dataset.recipe, join(work, calibration));
    }
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

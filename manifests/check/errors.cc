// SPDX-License-Identifier: Apache-2.0
// Noise: pictures far noisier than the others, that missed the error which was wanted, or lost samples.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

constexpr Threshold k_errors_over_median{
    "errors_over_median",
    3,
    {.least = 1},
    "How many times the median's a picture's relative_error may be"};
constexpr Threshold k_errors_removed{"errors_removed_energy",
                                     0.01,
                                     {.least = 0, .most = 1},
                                     "Share of a picture's light that may be cut off as outliers"};
constexpr Threshold k_errors_most{
    "errors_most",
    0,
    {.least = 0},
    "The relative_error a picture may have (the upper end of its 95 % interval); 0: any"};

/// The upper end of the error's interval, or the error where it has none.
std::optional<double> upper_error(const ImageRecord& image) {
  return image.film.error_high ? image.film.error_high : image.relative_error;
}

void check_errors(const CheckInput& input, CheckReport& report) {
  std::vector<double> errors;
  for (const ImageRecord& image : input.images)
    if (image.relative_error) errors.push_back(*image.relative_error);
  const std::uint64_t all = input.images.size();
  const double over_median = input.threshold(k_errors_over_median);
  const double removed_energy = input.threshold(k_errors_removed),
               most = input.threshold(k_errors_most);
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    const double median = *middle;
    // engine.error bounds what is seen, the developed picture; relative_error is of the linear one, whose
    // bright pixels count more.
    const std::string target = input.setting("engine.error");
    const bool has_target = !target.empty() && target != "false";
    report.add(has_target ? CheckLevel::note : CheckLevel::warning,
               fmt::format("pictures are more than {} times as noisy as the median ({:.3g})",
                           over_median, median),
               ids_where(input.images,
                         [&](const ImageRecord& image) {
                           return image.relative_error &&
                                  *image.relative_error > over_median * median;
                         }),
               errors.size(),
               has_target ? "before tone mapping; what is seen of it engine.error bounds in all"
                          : "engine.error gives all pictures one noise");
  }
  if (most > 0)
    report.add(
        CheckLevel::warning, fmt::format("pictures may have an error above {:g}", most),
        ids_where(input.images,
                  [&](const ImageRecord& image) { return upper_error(image).value_or(0) > most; }),
        errors.size(), "engine.error");
  report.add(CheckLevel::warning, "pictures did not reach the error that was wanted",
             ids_where(input.images, [](const ImageRecord& image) { return image.film.capped; }),
             all, "engine.max_spp lets them go on");
  report.add(
      CheckLevel::warning, "pictures lost samples that were NaN, infinite or negative",
      ids_where(input.images, [](const ImageRecord& image) { return image.rejected_samples > 0; }),
      all);
  report.add(CheckLevel::note,
             fmt::format("pictures have over {:g} % of their light cut off as outliers",
                         100 * removed_energy),
             ids_where(input.images,
                       [&](const ImageRecord& image) {
                         return image.film.removed_energy > removed_energy;
                       }),
             all, "engine.outlier_limit = 0 keeps it, and its noise");
}

}  // namespace

Check errors_check() {
  return {"errors",
          "pictures noisier than wanted or than the others",
          check_errors,
          {k_errors_over_median, k_errors_removed, k_errors_most}};
}

}  // namespace ds

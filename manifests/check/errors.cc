// SPDX-License-Identifier: Apache-2.0
// Noise: pictures far noisier than the others, that missed the error which was wanted, or lost samples.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

constexpr double k_most_over_median = 3;
constexpr double k_most_removed_energy = 0.01;

void check_errors(const CheckInput& input, CheckReport& report) {
  std::vector<double> errors;
  for (const ImageRecord& image : input.images)
    if (image.relative_error) errors.push_back(*image.relative_error);
  const std::uint64_t all = input.images.size();
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    const double median = *middle;
    report.add(CheckLevel::warning,
               fmt::format("pictures are more than {} times as noisy as the median ({:.3g})",
                           k_most_over_median, median),
               ids_where(input.images,
                         [&](const ImageRecord& image) {
                           return image.relative_error &&
                                  *image.relative_error > k_most_over_median * median;
                         }),
               errors.size(), "engine.error gives all pictures one noise");
  }
  report.add(CheckLevel::warning, "pictures did not reach the error that was wanted",
             ids_where(input.images, [](const ImageRecord& image) { return image.film.capped; }),
             all, "engine.max_spp lets them go on");
  report.add(
      CheckLevel::warning, "pictures lost samples that were NaN, infinite or negative",
      ids_where(input.images, [](const ImageRecord& image) { return image.rejected_samples > 0; }),
      all);
  report.add(CheckLevel::note,
             fmt::format("pictures have over {:g} % of their light cut off as outliers",
                         100 * k_most_removed_energy),
             ids_where(input.images,
                       [](const ImageRecord& image) {
                         return image.film.removed_energy > k_most_removed_energy;
                       }),
             all, "engine.outlier_limit = 0 keeps it, and its noise");
}

}  // namespace

Check errors_check() {
  return {"errors", "pictures noisier than wanted or than the others", check_errors};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Models of which the picture's frame cuts some off.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <optional>

namespace ds {
namespace {

constexpr Threshold k_truncation_most{
    "truncation_most", 0.5, {.least = 0, .most = 1}, "truncation that a model may have"};

/// The share that is outside; nothing where it is not known. What is beside the camera has no end.
std::optional<double> cut_of(const ImageRecord& image) {
  const PixelCounts& counts = image.pixel_counts;
  if (!counts.beyond) return std::nullopt;
  if (counts.whole == 0U) return 1;
  return *counts.beyond == 0
             ? 0
             : static_cast<double>(*counts.beyond) / static_cast<double>(*counts.whole);
}

void check_truncation(const CheckInput& input, CheckReport& report) {
  const double most = input.threshold(k_truncation_most);
  const auto known =
      ids_where(input.images, [](const ImageRecord& i) { return cut_of(i).has_value(); });
  report.add(
      CheckLevel::warning, fmt::format("images cut off over {:g} % of their model", 100 * most),
      ids_where(input.images, [&](const ImageRecord& i) { return cut_of(i).value_or(0) > most; }),
      known.size(), "camera.distance_m = \"fit\"");
  report.add(CheckLevel::note, "images cut some of their model off",
             ids_where(input.images,
                       [&](const ImageRecord& i) {
                         const double cut = cut_of(i).value_or(0);
                         return cut > 0 && cut <= most;
                       }),
             known.size(), "camera.distance_m = \"fit\"");
}

}  // namespace

Check truncation_check() {
  return {"truncation", "models that the frame cuts off", check_truncation, {k_truncation_most}};
}

}  // namespace ds

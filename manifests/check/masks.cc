// SPDX-License-Identifier: Apache-2.0
// Masks that show nothing, next to nothing or nothing else, and models that are hidden.
#include "manifests/check/check.h"

namespace ds {
namespace {

constexpr double k_least_share = 0.005, k_most_share = 0.9, k_least_visible = 0.5;

/// Of the picture's pixels; nothing without a mask.
std::optional<double> share_of(const ImageRecord& image) {
  if (!image.pixel_counts.model) return std::nullopt;
  return static_cast<double>(*image.pixel_counts.model) /
         (static_cast<double>(image.width) * static_cast<double>(image.height));
}

std::optional<double> visible_of(const ImageRecord& image) {
  const PixelCounts& counts = image.pixel_counts;
  if (!counts.model || !counts.amodal || *counts.amodal == 0) return std::nullopt;
  return static_cast<double>(*counts.model) / static_cast<double>(*counts.amodal);
}

void check_masks(const CheckInput& input, CheckReport& report) {
  const auto masks =
      ids_where(input.images, [](const ImageRecord& i) { return share_of(i).has_value(); });
  if (masks.empty()) {
    report.say(CheckLevel::note, "the dataset has no masks: whether models are seen is not known",
               "outputs.mask = true");
    return;
  }
  const auto where = [&](const auto& is) {
    return ids_where(input.images, [&](const ImageRecord& image) {
      const auto share = share_of(image);
      return share && is(*share);
    });
  };
  report.add(CheckLevel::error, "images show nothing of their model",
             where([](double share) { return share == 0; }), masks.size());
  report.add(CheckLevel::warning, "images show their model on under 0.5 % of the picture",
             where([](double share) { return share > 0 && share < k_least_share; }), masks.size(),
             "camera.distance_m = \"fit\"");
  report.add(CheckLevel::warning, "images show nearly nothing but their model, on over 90 %",
             where([](double share) { return share > k_most_share; }), masks.size(),
             "camera.distance_m = \"fit\"");
  report.add(
      CheckLevel::note, "images show under half of what would be seen of their model alone",
      ids_where(input.images,
                [](const ImageRecord& i) { return visible_of(i).value_or(1) < k_least_visible; }),
      masks.size());
}

}  // namespace

Check masks_check() {
  return {"masks", "models that are not seen, hardly seen or hidden", check_masks};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Masks that show nothing, next to nothing or nothing else, and models that are hidden.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

namespace ds {
namespace {

constexpr NumberRange k_share{.least = 0, .most = 1};
constexpr Threshold k_masks_least{"masks_least", 0.005, k_share,
                                  "Share of the picture on which a model must be seen"};
constexpr Threshold k_masks_most{"masks_most", 0.9, k_share,
                                 "Share of the picture on which a model may be seen"};
constexpr Threshold k_masks_visible{"masks_visible", 0.5, k_share,
                                    "visible_fraction that a model must have"};

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

void check_hidden_distractors(const CheckInput& input, CheckReport& report) {
  std::vector<std::string> hidden;
  std::uint64_t counted = 0;
  for (const ImageRecord& image : input.images)
    for (const ObjectRecord& object : image.objects) {
      if (!object.pixels) continue;
      ++counted;
      if (object.pixels->seen == 0) hidden.push_back(image.id);
    }
  report.add(CheckLevel::note, "distractors are out of their picture or wholly hidden", hidden,
             counted);
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
  const double least = input.threshold(k_masks_least), most = input.threshold(k_masks_most),
               visible = input.threshold(k_masks_visible);
  report.add(CheckLevel::error, "images show nothing of their model",
             where([](double share) { return share == 0; }), masks.size());
  report.add(CheckLevel::warning,
             fmt::format("images show their model on under {:g} % of the picture", 100 * least),
             where([&](double share) { return share > 0 && share < least; }), masks.size(),
             "camera.distance_m = \"fit\"; for thin models a larger engine.width");
  report.add(CheckLevel::warning,
             fmt::format("images show nearly nothing but their model, on over {:g} %", 100 * most),
             where([&](double share) { return share > most; }), masks.size(),
             "camera.distance_m = \"fit\"");
  report.add(CheckLevel::note,
             fmt::format("images show under {:g} % of what would be seen of their model alone",
                         100 * visible),
             ids_where(input.images,
                       [&](const ImageRecord& i) { return visible_of(i).value_or(1) < visible; }),
             masks.size());
  check_hidden_distractors(input, report);
}

}  // namespace

Check masks_check() {
  return {"masks",
          "models that are not seen, hardly seen or hidden",
          check_masks,
          {k_masks_least, k_masks_most, k_masks_visible}};
}

}  // namespace ds

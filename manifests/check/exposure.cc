// SPDX-License-Identifier: Apache-2.0
// Pictures that are black, or clipped at white, by the counts of pixel_counts.h.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

namespace ds {
namespace {

constexpr Threshold k_exposure_lit{
    "exposure_lit",
    0.001,
    {.least = 0, .most = 1},
    "Share of a picture's pixels that must be above 4 of 255 in some channel"};
constexpr Threshold k_exposure_white{"exposure_white",
                                     0.25,
                                     {.least = 0, .most = 1},
                                     "Share of a picture's pixels that may be clipped at white"};

std::uint64_t pixels_of(const ImageRecord& image) {
  return static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
}

void check_exposure(const CheckInput& input, CheckReport& report) {
  const std::uint64_t all = input.images.size();
  const auto share = [&](const std::optional<std::uint64_t>& count, const ImageRecord& image) {
    return static_cast<double>(*count) / static_cast<double>(pixels_of(image));
  };
  const double least_lit = input.threshold(k_exposure_lit),
               most_white = input.threshold(k_exposure_white);
  report.add(CheckLevel::error,
             fmt::format("pictures are black: under {:g} % of their pixels are above 4 of 255",
                         100 * least_lit),
             ids_where(input.images,
                       [&](const ImageRecord& image) {
                         const auto& lit = image.pixel_counts.lit;
                         return lit && share(lit, image) < least_lit;
                       }),
             all, "outputs.tone_map_scale, or lights in the environment");
  report.add(
      CheckLevel::warning,
      fmt::format("pictures are clipped at white on over {:g} % of their pixels", 100 * most_white),
      ids_where(input.images,
                [&](const ImageRecord& image) {
                  const auto& white = image.pixel_counts.white;
                  return white && share(white, image) > most_white;
                }),
      all, "outputs.tone_map_scale");
}

}  // namespace

Check exposure_check() {
  return {"exposure",
          "pictures that are black or clipped at white",
          check_exposure,
          {k_exposure_lit, k_exposure_white}};
}

}  // namespace ds

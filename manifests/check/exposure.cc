// SPDX-License-Identifier: Apache-2.0
// Pictures that are black, or clipped at white, by the counts of pixel_counts.h.
#include "manifests/check/check.h"

namespace ds {
namespace {

std::uint64_t pixels_of(const ImageRecord& image) {
  return static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
}

void check_exposure(const CheckInput& input, CheckReport& report) {
  const std::uint64_t all = input.images.size();
  const auto share = [&](const std::optional<std::uint64_t>& count, const ImageRecord& image) {
    return static_cast<double>(*count) / static_cast<double>(pixels_of(image));
  };
  report.add(CheckLevel::error, "pictures are black: under 1 pixel in 1000 is above 4 of 255",
             ids_where(input.images,
                       [&](const ImageRecord& image) {
                         const auto& lit = image.pixel_counts.lit;
                         return lit && share(lit, image) < 0.001;
                       }),
             all, "outputs.tone_map_scale, or lights in the environment");
  report.add(CheckLevel::warning, "pictures are clipped at white on over a quarter of their pixels",
             ids_where(input.images,
                       [&](const ImageRecord& image) {
                         const auto& white = image.pixel_counts.white;
                         return white && share(white, image) > 0.25;
                       }),
             all, "outputs.tone_map_scale");
}

}  // namespace

Check exposure_check() {
  return {"exposure", "pictures that are black or clipped at white", check_exposure};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/limits.h"

#include "tracer/base/error.h"

namespace ds {

void check_limits(const Recipe& recipe, const ImageSpec& image, const Product& picture) {
  const FilmFacts& facts = picture.facts;
  // A record of an older dsbuild holds the total only; it traced every pixel alike.
  const std::uint64_t samples = facts.samples > 0
                                    ? facts.samples
                                    : static_cast<std::uint64_t>(image.engine.width) *
                                          static_cast<std::uint64_t>(image.engine.height) *
                                          static_cast<std::uint64_t>(image.engine.spp);
  const double share = static_cast<double>(picture.rejected_samples) / static_cast<double>(samples);
  if (!(share > recipe.rejected_limit)) return;
  fail(
      ErrorKind::asset,
      "of {} samples {} had to be left out ({} NaN, {} infinite, {} negative), more than the share "
      "of {} that engine.rejected_limit allows",
      samples, picture.rejected_samples, facts.nan_samples, facts.infinite_samples,
      facts.negative_samples, recipe.rejected_limit);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Pixels far lighter than all around them: light paths that samples seldom find.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

namespace ds {
namespace {

constexpr Threshold k_most{
    "fireflies_most",
    0.0001,
    {.least = 0, .most = 1},
    "Share of a picture's pixels that may be lighter than all but one or two "
    "of those around them by 0.15 of 1"};

void check_fireflies(const CheckInput& input, CheckReport& report) {
  const double most = input.threshold(k_most);
  std::vector<std::string> specked;
  std::uint64_t pictures = 0;
  for (std::size_t i = 0; i < input.files.pictures.size(); ++i) {
    if (!input.files.pictures[i]) continue;
    ++pictures;
    const PictureFacts& facts = *input.files.pictures[i];
    if (static_cast<double>(facts.specks) > most * static_cast<double>(facts.pixels))
      specked.push_back(input.images[i].id);
  }
  report.add(CheckLevel::warning,
             fmt::format("pictures have specks on over {:g} % of their pixels", 100 * most),
             specked, pictures,
             "engine.outlier_limit cuts them off, engine.error gives them more samples");
}

}  // namespace

Check fireflies_check() {
  return {"fireflies", "pixels far lighter than all around them", check_fireflies, {k_most}, true};
}

}  // namespace ds

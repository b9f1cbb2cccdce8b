// SPDX-License-Identifier: Apache-2.0
// Depths that do not agree with poses, masks and the other views of a model.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

namespace ds {
namespace {

constexpr Threshold k_elsewhere{"depths_elsewhere",
                                0.02,
                                {.least = 0, .most = 1},
                                "Share of a mask's pixels whose depth may lie outside of the box "
                                "around the model"};
constexpr Threshold k_missed{"depths_missed",
                             0.05,
                             {.least = 0, .most = 1},
                             "Share of the places that one view's depths show of a model behind "
                             "which another view may see"};

/// Fewer places than these tell nothing: rods and the gaps between them may look like one piece.
constexpr std::uint64_t k_least_compared = 20;

void check_depths(const CheckInput& input, CheckReport& report) {
  const double elsewhere = input.threshold(k_elsewhere), missed = input.threshold(k_missed);
  std::vector<std::string> off, apart;
  std::uint64_t shown = 0, compared = 0;
  const auto is_over = [](std::uint64_t part, std::uint64_t whole, double most) {
    return static_cast<double>(part) > most * static_cast<double>(whole);
  };
  for (std::size_t i = 0; i < input.files.depths.size(); ++i) {
    if (!input.files.depths[i]) continue;
    const DepthFacts& facts = *input.files.depths[i];
    shown += facts.shown > 0 ? 1U : 0U;
    compared += facts.compared >= k_least_compared ? 1U : 0U;
    if (is_over(facts.elsewhere, facts.shown, elsewhere)) off.push_back(input.images[i].id);
    if (facts.compared >= k_least_compared && is_over(facts.missed, facts.compared, missed))
      apart.push_back(input.images[i].id);
  }
  const std::string advice = "depth, mask and manifest are not of one picture: dsbuild verify";
  report.add(CheckLevel::error,
             fmt::format("images have depths where their model is not, on more than {:g} % of it",
                         100 * elsewhere),
             off, shown, advice);
  report.add(CheckLevel::error,
             fmt::format("images have depths through which another view of the model sees, on more "
                         "than {:g} % of what both look at",
                         100 * missed),
             apart, compared, advice);
}

}  // namespace

Check depths_check() {
  return {"depths",
          "depths that do not agree with poses, masks and other views of the model",
          check_depths,
          {k_elsewhere, k_missed},
          true};
}

}  // namespace ds

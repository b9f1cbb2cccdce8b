// SPDX-License-Identifier: Apache-2.0
// Pictures whose model can hardly be told from what is behind it.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

namespace ds {
namespace {

constexpr Threshold k_least{
    "contrast_least",
    0.03,
    {.least = 0, .most = 1},
    "How far a picture's values inside and outside its mask's edge must be apart (mean, of 1)"};

void check_contrast(const CheckInput& input, CheckReport& report) {
  const double least = input.threshold(k_least);
  std::vector<std::string> faint;
  std::uint64_t outlined = 0;
  for (std::size_t i = 0; i < input.files.pictures.size(); ++i) {
    if (!input.files.pictures[i] || !input.files.pictures[i]->edge_contrast) continue;
    ++outlined;
    if (*input.files.pictures[i]->edge_contrast < least) faint.push_back(input.images[i].id);
  }
  report.add(
      CheckLevel::warning,
      fmt::format("pictures show their model less than {:g} apart from what is behind it", least),
      faint, outlined, "another material or environment, or more light");
}

}  // namespace

Check contrast_check() {
  return {"contrast",
          "models that can hardly be told from what is behind them",
          check_contrast,
          {k_least},
          true};
}

}  // namespace ds

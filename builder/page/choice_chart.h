// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/accuracy.h"
#include "builder/page/axis.h"

#include <string>
#include <vector>

namespace ds {

/// Both axes, the same for all charts of a page so that they can be compared.
struct ChoiceAxes {
  Axis time, bias;
};
ChoiceAxes choice_axes(const Accuracy& accuracy);

/// Rows of choices, two columns: their time over the recipe's with its range, and how much they
/// change the picture (logarithmic; "none seen" where the difference is lost in the noise).
std::string choice_chart(const std::string& title, const std::vector<ChoiceCost>& costs,
                         const ChoiceAxes& axes);

}  // namespace ds

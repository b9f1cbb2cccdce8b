// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/page/page.h"

#include <string>
#include <vector>

namespace ds {

/// Pairs of one environment, at most as many as a chart can tell apart; an environment with more
/// materials has several groups.
std::vector<std::vector<const PairAccuracy*>> by_environment(const Accuracy& accuracy);

/// Sections of the page: HTML with its heading.
/// Every metric against samples, time, or both.
std::string error_section(const Accuracy& accuracy, Against against);
/// Mask and depth against rays a pixel, time, or both.
std::string geometry_section(const Accuracy& accuracy, Against against);
/// Lost light and time against path depth; empty where it was not measured.
std::string depth_section(const Accuracy& accuracy);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace ds {

enum class Scale { linear, log2, log10 };

struct Tick {
  double value = 0;
  std::string label;  ///< empty: a line only
};

/// One axis of a chart: which values lie where.
struct Axis {
  std::string label;  ///< with its unit: "error (%)"
  Scale scale = Scale::linear;
  double low = 0, high = 1;  ///< low < high; above 0 for logarithmic scales
  std::vector<Tick> ticks;   ///< within [low, high], ascending

  /// 0 at `low`, 1 at `high`.
  double place(double value) const;
};

/// An axis that holds all values with a little room, from tick to tick where it is linear. Values
/// must be finite, and above 0 for logarithmic scales; without any the axis is 0 to 1 (1 to 10). Of
/// a logarithmic axis' ticks about `most_labels` are named: more run into each other where an axis
/// is as long as a chart is wide.
Axis axis_for(const std::string& label, Scale scale, const std::vector<double>& values,
              int most_labels = 8);

/// "0.02", "3", "1500", "2e-07": at most three significant digits.
std::string short_number(double value);

}  // namespace ds

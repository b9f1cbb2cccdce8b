// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/fit.h"
#include "builder/page/axis.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ds {

/// A point with its error bars; x without any where low = high. A bar whose bound lies beyond the
/// axis, is infinite, or is 0 on a logarithmic axis, goes to the frame and has no cap there.
struct ChartPoint {
  Interval x, y;
};

struct ChartSeries {
  std::string name;
  int style = 0;  ///< colour and shape of its markers
  std::vector<ChartPoint> points;
  bool joined = true;                          ///< by straight lines
  std::vector<std::pair<double, double>> fit;  ///< ends of a line that is drawn through them
};

/// A dashed line across the chart at a y, named right of the frame.
struct ChartGuide {
  double y = 0;
  std::string label;
};

struct Chart {
  std::string title;
  std::string x_label, y_label;
  Scale x_scale = Scale::linear, y_scale = Scale::linear;
  std::vector<ChartSeries> series;
  std::vector<ChartGuide> guides;      ///< those outside of what the points span are left out
  std::vector<double> x_also, y_also;  ///< values the axes are to hold too
};

/// Points that a logarithmic axis cannot show (not above 0) are left out.
std::string to_svg(const Chart& chart);

/// Styles there are; beyond them series are told apart by more charts, not more colours.
inline constexpr int k_chart_styles = 6;

/// A line of markers and names, for the charts of one row.
std::string legend(const std::vector<std::string>& names);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/page/chart.h"

#include "builder/page/svg.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

constexpr double k_width = 350, k_height = 226;
constexpr double k_left = 56, k_right = 26, k_top = 26, k_bottom = 42;
constexpr double k_cap = 2.5;  ///< half the width of an error bar's end

std::string css(const char* kind, int style) {
  return fmt::format("{} s{}", kind, style % k_chart_styles);
}

bool shown(double value, Scale scale) {
  return std::isfinite(value) && (scale == Scale::linear || value > 0);
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart), svg_(k_width, k_height, chart.title), x_(x_axis()), y_(y_axis()) {}

  std::string draw() {
    frame();
    for (const ChartGuide& guide : chart_.guides)
      draw_guide(guide);
    for (const ChartSeries& series : chart_.series)
      draw_lines(series);
    for (const ChartSeries& series : chart_.series)
      draw_points(series);
    return svg_.str();
  }

 private:
  bool is_shown(const ChartPoint& p) const {
    return shown(p.x.value, chart_.x_scale) && shown(p.y.value, chart_.y_scale);
  }
  Axis x_axis() const {
    std::vector<double> values = chart_.x_also;
    for (const ChartSeries& series : chart_.series)
      for (const ChartPoint& p : series.points)
        if (is_shown(p)) values.push_back(p.x.value);
    return axis_for(chart_.x_label, chart_.x_scale, values);
  }
  Axis y_axis() const {
    std::vector<double> values = chart_.y_also;
    for (const ChartSeries& series : chart_.series)
      for (const ChartPoint& p : series.points)
        if (is_shown(p)) values.push_back(p.y.value);
    return axis_for(chart_.y_label, chart_.y_scale, values);
  }
  /// 0 to 1 along the axis.
  static double share(const Axis& axis, double value) {
    if (axis.scale != Scale::linear && value <= 0) return 0;
    return std::clamp(axis.place(value), 0.0, 1.0);
  }
  double x_at(double value) const {
    return k_left + share(x_, value) * (k_width - k_left - k_right);
  }
  double y_at(double value) const {
    return k_height - k_bottom - share(y_, value) * (k_height - k_top - k_bottom);
  }

  void frame() {
    svg_.text(k_left, 15, Anchor::start, "title", chart_.title);
    for (const Tick& tick : y_.ticks) {
      const double y = y_at(tick.value);
      svg_.line(k_left, y, k_width - k_right, y, tick.label.empty() ? "grid faint" : "grid");
      svg_.text(k_left - 6, y + 3.5, Anchor::end, "tick", tick.label);
    }
    for (const Tick& tick : x_.ticks) {
      const double x = x_at(tick.value);
      svg_.line(x, k_height - k_bottom, x, k_height - k_bottom + 4, "axis");
      svg_.text(x, k_height - k_bottom + 15, Anchor::middle, "tick", tick.label);
    }
    svg_.line(k_left, k_height - k_bottom, k_width - k_right, k_height - k_bottom, "axis");
    svg_.text((k_left + k_width - k_right) / 2, k_height - 8, Anchor::middle, "label", x_.label);
    svg_.text_upwards(12, (k_top + k_height - k_bottom) / 2, "label", y_.label);
  }

  void draw_guide(const ChartGuide& guide) {
    if (guide.y < y_.low || guide.y > y_.high) return;
    const double y = y_at(guide.y);
    svg_.line(k_left, y, k_width - k_right, y, "guide");
    svg_.text(k_width - k_right + 3, y + 3.5, Anchor::start, "guide-text", guide.label);
  }

  void draw_lines(const ChartSeries& series) {
    std::vector<std::pair<double, double>> line;
    if (series.joined)
      for (const ChartPoint& p : series.points)
        if (is_shown(p)) line.emplace_back(x_at(p.x.value), y_at(p.y.value));
    for (const auto& [x, y] : series.fit)
      line.emplace_back(x_at(x), y_at(y));
    if (line.size() > 1) svg_.polyline(line, css("line", series.style));
  }

  /// Of the point at (x, y).
  void draw_bar(const Interval& of, const Axis& axis, double x, double y, bool across,
                const std::string& bar) {
    const auto at = [&](double value) { return across ? x_at(value) : y_at(value); };
    const double low = at(of.low);
    const double high = at(of.high);
    // A bar that the marker hides says nothing.
    if (std::abs(high - low) <= 7) return;
    if (across)
      svg_.line(low, y, high, y, bar);
    else
      svg_.line(x, high, x, low, bar);
    for (const double end : {of.low, of.high}) {
      if (end < axis.low || end > axis.high) continue;
      if (across)
        svg_.line(at(end), y - k_cap, at(end), y + k_cap, bar);
      else
        svg_.line(x - k_cap, at(end), x + k_cap, at(end), bar);
    }
  }

  void draw_points(const ChartSeries& series) {
    for (const ChartPoint& p : series.points) {
      if (!is_shown(p)) continue;
      const double x = x_at(p.x.value);
      const double y = y_at(p.y.value);
      draw_bar(p.x, x_, x, y, true, css("bar", series.style));
      draw_bar(p.y, y_, x, y, false, css("bar", series.style));
      svg_.marker(x, y, series.style, css("mark", series.style),
                  fmt::format("{}: {} at {}", series.name, short_number(p.y.value),
                              short_number(p.x.value)));
    }
  }

  const Chart& chart_;
  Svg svg_;
  Axis x_, y_;
};

}  // namespace

std::string to_svg(const Chart& chart) {
  return Drawing(chart).draw();
}

std::string legend(const std::vector<std::string>& names) {
  std::string html = "<p class=\"legend\">";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int style = static_cast<int>(i);
    Svg svg(26, 12, names[i]);
    svg.line(1, 6, 25, 6, css("line", style));
    svg.marker(13, 6, style, css("mark", style), "");
    html += "<span>" + svg.str() + escaped(names[i]) + "</span>";
  }
  return html + "</p>";
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/page/choice_chart.h"

#include "builder/page/axis.h"
#include "builder/page/svg.h"
#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

constexpr double k_choice_width = 526, k_choice_top = 46, k_row = 17, k_choice_bottom = 40;
/// Both columns, left to right edge.
constexpr double k_time_left = 176, k_time_right = 332, k_bias_left = 356, k_bias_right = 504;
/// A column is less than half as wide as a chart, and shares of a strict and a fast picture are as
/// small as "1e-06".
constexpr int k_bias_labels = 3;
/// A label of more characters would run into the first column.
constexpr std::size_t k_longest_label = 30;

std::string label_of(const Choice& choice) {
  std::string text =
      choice.group == k_effect_group ? "no " + choice.name : choice.group + ": " + choice.name;
  if (choice.group == k_effect_group && choice.name.starts_with("texture "))
    text = choice.name.substr(8) + " as its mean";
  if (text.size() > k_longest_label) text = text.substr(0, k_longest_label - 3) + "...";
  return text;
}

class ChoiceDrawing {
 public:
  ChoiceDrawing(const std::string& title, const std::vector<ChoiceCost>& costs,
                const ChoiceAxes& axes)
      : costs_(costs),
        bottom_(k_choice_top + k_row * static_cast<double>(costs.size())),
        svg_(k_choice_width, bottom_ + k_choice_bottom, title),
        time_(axes.time),
        bias_(axes.bias) {
    svg_.text(4, 15, Anchor::start, "title", title);
  }

  std::string draw() {
    column(time_, k_time_left, k_time_right, "time over the recipe's");
    column(bias_, k_bias_left, k_bias_right, "change of the picture");
    const double one = at(time_, k_time_left, k_time_right, 1);
    svg_.line(one, k_choice_top, one, bottom_, "axis");
    for (std::size_t i = 0; i < costs_.size(); ++i)
      row(costs_[i], k_choice_top + k_row * (static_cast<double>(i) + 0.5));
    return svg_.str();
  }

 private:
  static double at(const Axis& axis, double left, double right, double value) {
    return left + std::clamp(axis.place(value), 0.0, 1.0) * (right - left);
  }

  void column(const Axis& axis, double left, double right, const std::string& head) {
    svg_.text((left + right) / 2, 34, Anchor::middle, "label", head);
    for (const Tick& tick : axis.ticks) {
      if (tick.label.empty()) continue;
      const double x = at(axis, left, right, tick.value);
      svg_.line(x, k_choice_top, x, bottom_, "grid");
      svg_.text(x, bottom_ + 14, Anchor::middle, "tick", tick.label);
    }
    svg_.text((left + right) / 2, bottom_ + 31, Anchor::middle, "label", axis.label);
  }

  void row(const ChoiceCost& cost, double y) {
    svg_.text(k_time_left - 10, y + 3.5, Anchor::end, "row", label_of(cost.choice));
    const double one = at(time_, k_time_left, k_time_right, 1);
    const double x = at(time_, k_time_left, k_time_right, cost.time.value);
    svg_.rectangle(std::min(one, x), y - 4.5, std::abs(one - x), 9,
                   cost.time.value <= 1 ? "less" : "more");
    svg_.line(at(time_, k_time_left, k_time_right, cost.time.low), y,
              at(time_, k_time_left, k_time_right, cost.time.high), y, "range");
    if (!cost.bias) {
      svg_.text(k_bias_left + 4, y + 3.5, Anchor::start, "none", "none seen");
      return;
    }
    const auto bias_at = [&](double share) {
      return at(bias_, k_bias_left, k_bias_right, 100 * share);
    };
    svg_.line(bias_at(cost.bias->low), y, bias_at(cost.bias->high), y, "bar s0");
    svg_.marker(bias_at(cost.bias->value), y, 0, "mark s0",
                short_number(100 * cost.bias->value) + " %");
  }

  const std::vector<ChoiceCost>& costs_;
  double bottom_;
  Svg svg_;
  const Axis &time_, &bias_;
};

}  // namespace

ChoiceAxes choice_axes(const Accuracy& accuracy) {
  std::vector<double> times{0, 1};
  std::vector<double> biases;
  for (const PairAccuracy& pair : accuracy.pairs)
    for (const ChoiceCost& cost : pair.choices) {
      if (cost.choice.group == k_depth_group) continue;
      times.push_back(cost.time.value);
      if (cost.bias) biases.push_back(100 * cost.bias->value);
    }
  return {axis_for("ratio", Scale::linear, times),
          axis_for("relative RMS (%)", Scale::log10, biases, k_bias_labels)};
}

std::string choice_chart(const std::string& title, const std::vector<ChoiceCost>& costs,
                         const ChoiceAxes& axes) {
  DS_ASSERT(!costs.empty());
  return ChoiceDrawing(title, costs, axes).draw();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/page/page_charts.h"

#include "builder/page/chart.h"
#include "builder/page/svg.h"

#include <fmt/format.h>

#include <algorithm>

namespace ds {
namespace {

using Group = std::vector<const PairAccuracy*>;

/// How a metric is shown.
struct Display {
  const char* title;
  const char* label;
  double factor;  ///< percent from shares
  Metric metric;
  Scale scale;
};
constexpr Display k_displays[] = {
    {"Error", "relative RMS error (%)", 100, Metric::error, Scale::log10},
    {"relMSE", "relMSE", 1, Metric::rel_mse, Scale::log10},
    {"Trimmed relMSE", "relMSE of the best 99.9 %", 1, Metric::rel_mse_trimmed, Scale::log10},
    {"PSNR", "PSNR (dB)", 1, Metric::psnr_db, Scale::linear},
    {"SSIM", "SSIM", 1, Metric::ssim, Scale::linear},
    {"FLIP", "mean FLIP", 1, Metric::flip, Scale::log10},
};

Interval scaled(const Interval& i, double factor) {
  return {i.value * factor, i.low * factor, i.high * factor};
}

Interval exact(double value) {
  return {value, value, value};
}

/// Seconds, or minutes where pictures take long.
struct TimeUnit {
  double seconds = 1;
  const char* name = "s";
};

TimeUnit time_unit(const Accuracy& accuracy) {
  double longest = 0;
  for (const PairAccuracy& pair : accuracy.pairs)
    for (const Rung& rung : pair.ladder)
      longest = std::max(longest, rung.seconds.value);
  return longest >= 120 ? TimeUnit{60, "min"} : TimeUnit{};
}

std::vector<std::string> materials(const Group& group) {
  std::vector<std::string> names;
  for (const PairAccuracy* pair : group)
    names.push_back(pair->material);
  return names;
}

std::string figure(const Group& group, const std::string& plots, const std::string& caption = "") {
  std::string html = "<h3>" + escaped(group.front()->environment) + "</h3>\n<figure>" +
                     legend(materials(group)) + "<div class=\"plots\">" + plots + "</div>";
  if (!caption.empty()) html += "<figcaption>" + caption + "</figcaption>";
  return html + "</figure>\n";
}

void add_guides(Chart& chart) {
  for (const double error : k_target_errors) {
    chart.guides.push_back({100 * error, short_number(100 * error) + " %"});
  }
}

ChartSeries ladder_series(const PairAccuracy& pair, int style, const Display& display,
                          std::optional<TimeUnit> time) {
  ChartSeries series{pair.material, style, {}, true, {}};
  for (const Rung& rung : pair.ladder) {
    const auto found = rung.metrics.find(display.metric);
    if (found == rung.metrics.end()) continue;
    series.points.push_back({time ? scaled(rung.seconds, 1 / time->seconds) : exact(rung.spp),
                             scaled(found->second, display.factor)});
  }
  if (display.metric == Metric::error && !time && pair.law) {
    series.joined = false;
    for (const double n : {pair.law->least_n, pair.law->most_n})
      series.fit.emplace_back(n, display.factor * pair.law->error(n));
  }
  return series;
}

std::string ladder_chart(const Group& group, const Display& display, std::optional<TimeUnit> time) {
  Chart chart;
  chart.title = fmt::format("{} against {}", display.title, time ? "time" : "samples");
  chart.x_label = time ? fmt::format("time of a picture ({})", time->name) : "samples a pixel";
  chart.y_label = display.label;
  chart.x_scale = time ? Scale::log10 : Scale::log2;
  chart.y_scale = display.scale;
  for (std::size_t i = 0; i < group.size(); ++i)
    chart.series.push_back(ladder_series(*group[i], static_cast<int>(i), display, time));
  if (display.metric == Metric::error) add_guides(chart);
  return to_svg(chart);
}

Chart geometry_chart(const Group& group, std::optional<TimeUnit> time, const char* title,
                     const char* label, Scale scale, double GeometryErrors::*error) {
  Chart chart;
  chart.title = fmt::format("{} against {}", title, time ? "time" : "rays");
  chart.x_label = time ? fmt::format("time of a mask ({})", time->name) : "rays a pixel";
  chart.y_label = label;
  chart.x_scale = time ? Scale::log10 : Scale::log2;
  chart.y_scale = scale;
  if (scale == Scale::linear) chart.y_also = {0};
  for (std::size_t i = 0; i < group.size(); ++i) {
    ChartSeries series{group[i]->material, static_cast<int>(i), {}, true, {}};
    for (const GeometryRung& rung : group[i]->geometry)
      series.points.push_back({exact(time ? rung.seconds / time->seconds : double(rung.rays)),
                               exact(100 * (rung.errors.*error))});
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Calls `draw` for samples, for time, or for both.
template <typename Draw>
std::string each_axis(Against against, const TimeUnit& time, const Draw& draw) {
  std::string html;
  if (against != Against::minutes) html += draw(std::optional<TimeUnit>());
  if (against != Against::spp) html += draw(std::optional<TimeUnit>(time));
  return html;
}

/// What a chart against path depth shows.
enum class DepthValue { loss, noise, time };

std::optional<Interval> value_of(const ChoiceCost& cost, DepthValue value) {
  if (value == DepthValue::time) return cost.time;
  if (value == DepthValue::loss)
    return cost.bias ? std::optional(scaled(*cost.bias, 100)) : std::nullopt;
  return cost.noise ? std::optional(exact(*cost.noise)) : std::nullopt;
}

std::string depth_chart(const Group& group, DepthValue value) {
  Chart chart;
  chart.title = value == DepthValue::time    ? "Time against path depth"
                : value == DepthValue::noise ? "Noise against path depth"
                                             : "Loss against path depth";
  chart.x_label = "most vertices of a path";
  chart.y_label = value == DepthValue::time    ? "time over the recipe's"
                  : value == DepthValue::noise ? "noise over the recipe's"
                                               : "change from depth 16 (%)";
  chart.x_scale = Scale::log2;
  chart.y_scale = value == DepthValue::loss ? Scale::log10 : Scale::linear;
  chart.x_also = {2, k_deepest};
  if (value != DepthValue::loss) chart.y_also = {0, 1};
  for (std::size_t i = 0; i < group.size(); ++i) {
    ChartSeries series{group[i]->material, static_cast<int>(i), {}, true, {}};
    for (const ChoiceCost& cost : group[i]->choices) {
      if (cost.choice.group != k_depth_group || !cost.choice.apply) continue;
      if (const auto y = value_of(cost, value))
        series.points.push_back({exact(cost.choice.number), *y});
    }
    chart.series.push_back(std::move(series));
  }
  return to_svg(chart);
}

/// "Lost by the recipe's own depths: 0.2 % (red-plastic), nothing seen (chrome)."
std::string own_loss(const Group& group) {
  std::string text = "Lost by the recipe's own depths: ";
  for (const PairAccuracy* pair : group)
    for (const ChoiceCost& cost : pair->choices)
      if (cost.choice.group == k_depth_group && !cost.choice.apply)
        text += fmt::format(
            "{} ({}), ",
            cost.bias ? short_number(100 * cost.bias->value) + " %" : std::string("nothing seen"),
            escaped(pair->material));
  return text.replace(text.size() - 2, 2, ".");
}

}  // namespace

std::vector<std::vector<const PairAccuracy*>> by_environment(const Accuracy& accuracy) {
  std::vector<Group> groups;
  for (const PairAccuracy& pair : accuracy.pairs) {
    if (groups.empty() || groups.back().front()->environment != pair.environment ||
        groups.back().size() == k_chart_styles)
      groups.emplace_back();
    groups.back().push_back(&pair);
  }
  return groups;
}

std::string error_section(const Accuracy& accuracy, Against against) {
  const TimeUnit time = time_unit(accuracy);
  std::string html =
      "<h2>Error of the picture</h2>\n<p>Bars: 95 % bounds from independent pictures, across, and "
      "the range of their times, along. PSNR, SSIM and FLIP are of the developed 8-bit pictures; "
      "FLIP (Andersson et al. 2020) says how visible the difference is when flipping between "
      "both, 0 for not at all. The reference's own noise counts in none of the first four.</p>\n";
  for (const Group& group : by_environment(accuracy)) {
    std::string plots;
    for (const Display& display : k_displays)
      plots += each_axis(against, time, [&](const std::optional<TimeUnit>& unit) {
        return ladder_chart(group, display, unit);
      });
    double noise = 0;
    for (const PairAccuracy* pair : group)
      noise = std::max(noise, pair->reference_error);
    html += figure(group, plots,
                   fmt::format("The straight lines are the fitted laws. Error of the reference: at "
                               "most {} %.",
                               short_number(100 * noise)));
  }
  return html;
}

std::string geometry_section(const Accuracy& accuracy, Against against) {
  const TimeUnit time{0.001, "ms"};
  std::string html =
      "<h2>Error of mask and depth</h2>\n<p>Both are traced with one ray through each pixel's "
      "centre, without lens and in strict arithmetic whatever the recipe says: exact there, blind "
      "to the rest of the pixel. They are compared with the share of each pixel that shows the "
      "model, and with the pixel's mean depth, by up to 256 rays a pixel. A mask's pixel is wrong "
      "where less than half of it is what the mask says.</p>\n";
  for (const Group& group : by_environment(accuracy)) {
    // Often no pixel is wrong, which a logarithm cannot show.
    const auto plots = each_axis(against, time, [&](const std::optional<TimeUnit>& unit) {
      return to_svg(geometry_chart(group, unit, "Mask error", "RMS of the share (%)", Scale::log10,
                                   &GeometryErrors::mask_rms)) +
             to_svg(geometry_chart(group, unit, "Wrong mask pixels", "share of the pixels (%)",
                                   Scale::linear, &GeometryErrors::mask_wrong)) +
             to_svg(geometry_chart(group, unit, "Depth error", "relative RMS (%)", Scale::log10,
                                   &GeometryErrors::depth_rms));
    });
    html += figure(group, plots);
  }
  return html;
}

std::string depth_section(const Accuracy& accuracy) {
  std::string html;
  for (const Group& group : by_environment(accuracy)) {
    const bool measured = std::any_of(group.begin(), group.end(), [](const PairAccuracy* pair) {
      return !pair->choices.empty();
    });
    if (!measured) continue;
    html += figure(group,
                   depth_chart(group, DepthValue::loss) + depth_chart(group, DepthValue::noise) +
                       depth_chart(group, DepthValue::time),
                   own_loss(group));
  }
  if (html.empty()) return "";
  return "<h2>Path depth</h2>\n<p>Total, diffuse, glossy and specular depth set to one number. The "
         "loss "
         "is the difference from depth 16, noise taken out; depths without a point have none that "
         "could be seen.</p>\n" +
         html;
}

}  // namespace ds

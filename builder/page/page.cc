// SPDX-License-Identifier: Apache-2.0
#include "builder/page/page.h"

#include "builder/page/axis.h"
#include "builder/page/choice_chart.h"
#include "builder/page/csv.h"
#include "builder/page/page_charts.h"
#include "builder/page/page_style.h"
#include "builder/page/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

std::string percent(double share) {
  return short_number(100 * share);
}

/// "3.2 ms", "0.5 s", "4.1 min", "2.3 h".
std::string duration(double seconds) {
  if (seconds < 0.1) return short_number(seconds * 1000) + " ms";
  if (seconds < 120) return short_number(seconds) + " s";
  if (seconds < 7200) return short_number(seconds / 60) + " min";
  return short_number(seconds / 3600) + " h";
}

std::string cell(const std::string& value, const std::string& bounds) {
  return "<td>" + value + (bounds.empty() ? "" : " <small>" + bounds + "</small>") + "</td>";
}

/// One cell a target, or one for all of them that says why there is none.
std::string target_cells(const PairAccuracy& pair) {
  if (pair.targets.empty())
    return fmt::format("<td class=\"why\" colspan=\"{}\">not told: {}</td>", k_target_errors.size(),
                       escaped(pair.no_targets));
  std::string cells;
  for (const Target& target : pair.targets) {
    const std::string value = duration(target.seconds.value);
    cells += cell(target.extrapolated ? "<span class=\"far\">" + value + " *</span>" : value,
                  duration(target.seconds.low) + " to " + duration(target.seconds.high));
  }
  return cells;
}

std::string summary_row(const PairAccuracy& pair) {
  const Rung& last = pair.ladder.back();
  std::string row = "<tr><td class=\"text\">" + escaped(pair.environment) +
                    "</td><td class=\"text\">" + escaped(pair.material) + "</td>";
  row += "<td>" + std::to_string(pair.images) + "</td>";
  const auto error = last.metrics.find(Metric::error);
  row += error == last.metrics.end()
             ? "<td>below the reference's</td>"
             : cell(percent(error->second.value) + " %",
                    percent(error->second.low) + " to " + percent(error->second.high));
  row += cell(duration(last.seconds.value), "");
  if (pair.law) {
    const Interval slope = pair.law->line.slope_interval();
    row += cell(fmt::format("{:.2f}", slope.value),
                std::isfinite(slope.low) ? fmt::format("{:.2f} to {:.2f}", slope.low, slope.high)
                                         : "no bounds");
  } else {
    row += "<td>none</td>";
  }
  return row + target_cells(pair) + "</tr>\n";
}

std::string summary_table(const Accuracy& accuracy) {
  std::string head =
      "<tr><th class=\"text\">environment</th><th class=\"text\">material</th><th>images</th>";
  head += fmt::format("<th>error at {0} spp</th><th>time at {0} spp</th><th>slope</th>",
                      accuracy.options.most_spp);
  for (const double target : k_target_errors)
    head += "<th>time to " + percent(target) + " %</th>";
  std::string rows;
  for (const PairAccuracy& pair : accuracy.pairs)
    rows += summary_row(pair);
  return "<div class=\"scroll\"><table id=\"summary\"><thead>" + head + "</tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string fact(const std::string& name, const std::string& value) {
  return "<div><dt>" + name + "</dt><dd>" + escaped(value) + "</dd></div>";
}

std::string facts(const Accuracy& accuracy) {
  const EngineSettings& engine = accuracy.engine;
  const AccuracyOptions& options = accuracy.options;
  return "<dl class=\"facts\">" +
         fact("picture", fmt::format("{} x {} pixels", engine.width, engine.height)) +
         fact("the recipe's samples", fmt::format("{} a pixel", engine.spp)) +
         fact("measured",
              fmt::format("1 to {} a pixel, {} pictures each", options.most_spp, options.seeds)) +
         fact("reference", fmt::format("{} samples a pixel, other seeds",
                                       2 * options.reference * options.most_spp)) +
         fact("arithmetic", engine.math == MathMode::strict ? "strict" : "fast") +
         fact("device", accuracy.device) + "</dl>\n";
}

std::string introduction(const Accuracy& accuracy, const std::string& csv,
                         const std::string& csv_name) {
  return fmt::format(
      "<h1>What accuracy costs: {}</h1>\n<p class=\"lead\">One picture for each environment and "
      "material of the recipe, traced with ever more samples and compared with a far better one. "
      "<a download=\"{}\" href=\"{}\">All numbers as CSV</a></p>\n{}",
      escaped(accuracy.recipe), escaped(csv_name), csv_link(csv), facts(accuracy));
}

std::string summary(const Accuracy& accuracy) {
  return "<h2>In short</h2>\n" + summary_table(accuracy) +
         "<p class=\"note\">Error: RMS difference of luminance from the reference over the mean "
         "luminance; small figures are 95 % bounds. Slope: of log error against log samples; "
         "-0.5 is what independent random samples give. Times are of tracing one picture, on this "
         "device alone. * beyond what was measured, by the fitted law.</p>\n";
}

/// "Plain float sums ...": one sentence, the least and the most of all pairs.
std::string sums_text(const Accuracy& accuracy) {
  double least = accuracy.pairs.front().plain_sums;
  double most = least;
  for (const PairAccuracy& pair : accuracy.pairs) {
    least = std::min(least, pair.plain_sums);
    most = std::max(most, pair.plain_sums);
  }
  return fmt::format(
      "<p id=\"sums\">Sums: plain floats in place of compensated ones would move the pictures by "
      "{} "
      "to {} % at {} samples a pixel. The time that they save stands below, with the other "
      "choices.</p>\n",
      percent(least), percent(most), accuracy.pairs.front().plain_sums_spp);
}

/// "Never left out with red-plastic: light spot, since without it the scene is dark." A line a
/// material.
std::string kept_text(const std::vector<const PairAccuracy*>& group) {
  std::string text;
  for (const PairAccuracy* pair : group) {
    std::string kept;
    for (const KeptEffect& effect : pair->kept)
      kept += (kept.empty() ? "" : "; ") + effect.effect.sort + " " + effect.effect.name +
              ", since " + effect.why;
    if (!kept.empty())
      text += (text.empty() ? "" : "<br>") +
              escaped("Never left out with " + pair->material + ": " + kept + ".");
  }
  return text.empty() ? "" : "<figcaption>" + text + "</figcaption>";
}

std::string choices_section(const Accuracy& accuracy) {
  std::string html;
  const ChoiceAxes axes = choice_axes(accuracy);
  for (const auto& group : by_environment(accuracy)) {
    std::string plots;
    for (const PairAccuracy* pair : group) {
      std::vector<ChoiceCost> costs;
      for (const ChoiceCost& cost : pair->choices)
        if (cost.choice.group != k_depth_group) costs.push_back(cost);
      if (!costs.empty()) plots += choice_chart(pair->material, costs, axes);
    }
    if (plots.empty()) continue;
    html += "<h3>" + escaped(group.front()->environment) +
            "</h3>\n<figure class=\"choices\"><div class=\"plots\">" + plots + "</div>" +
            kept_text(group) + "</figure>\n";
  }
  if (html.empty()) return "";
  return "<h2>What each choice costs</h2>\n<p>Each row changes one thing and keeps the samples: "
         "how long a picture then takes, and how far it moves from the recipe's, noise taken out. "
         "A bar to the left is time saved by leaving the effect out.</p>\n" +
         sums_text(accuracy) + html;
}

}  // namespace

std::string accuracy_page(const Accuracy& accuracy, Against against, const std::string& csv,
                          const std::string& csv_name) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>What accuracy costs: " +
      escaped(accuracy.recipe) + "</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>" +
      k_page_style + "</style></head>\n<body><main>\n";
  html += introduction(accuracy, csv, csv_name);
  html += summary(accuracy);
  html += error_section(accuracy, against);
  html += geometry_section(accuracy, against);
  html += depth_section(accuracy);
  html += choices_section(accuracy);
  return html + "</main></body></html>\n";
}

}  // namespace ds

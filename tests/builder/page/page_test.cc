// SPDX-License-Identifier: Apache-2.0
#include "builder/page/page.h"

#include "builder/page/axis.h"
#include "builder/page/chart.h"
#include "builder/page/csv.h"
#include "builder/page/svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>

namespace ds {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> found;
  for (const Tick& tick : axis.ticks)
    if (!tick.label.empty()) found.push_back(tick.label);
  return found;
}

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1))
    ++count;
  return count;
}

PairAccuracy pair(const std::string& material) {
  PairAccuracy p;
  p.environment = "attic, \"old\"";
  p.material = material;
  p.image = "mug.ply/0";
  p.images = 3;
  for (const int spp : {1, 2, 4}) {
    const double error = 0.5 / std::sqrt(spp);
    Rung rung;
    rung.spp = spp;
    rung.seconds = {0.25 * spp, 0.2 * spp, 0.3 * spp};
    rung.metrics[Metric::error] = {error, 0.75 * error, 1.25 * error};
    p.ladder.push_back(rung);
  }
  p.law = fit_power_law(std::vector<double>{1, 2, 4},
                        std::vector<double>{0.5, 0.5 / std::sqrt(2.0), 0.25});
  p.seconds = fit_line(std::vector<double>{1, 2, 4}, std::vector<double>{0.25, 0.5, 1});
  p.targets.push_back({0.05, {100, 90, 110}, {25, 22.5, 27.5}, true});
  ChoiceCost cost;
  cost.choice = {k_effect_group, "light <sun>", 0, true, [](Subject&) {}};
  cost.time = {0.5, 0.25, 0.75};
  cost.bias = Interval{0.5, 0.25, 0.75};
  p.choices.push_back(cost);
  return p;
}

Accuracy accuracy() {
  Accuracy a;
  a.recipe = "mugs & more";
  a.device = "a device";
  a.options.most_spp = 4;
  a.pairs = {pair("steel"), pair("clay")};
  return a;
}

TEST(Axis, TicksAreRoundNumbersWithin) {
  EXPECT_THAT(labels(axis_for("", Scale::linear, {0.1, 0.94})),
              testing::ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));
  EXPECT_THAT(labels(axis_for("", Scale::log2, {1, 16})),
              testing::ElementsAre("1", "2", "4", "8", "16"));
  EXPECT_THAT(labels(axis_for("", Scale::log10, {0.01, 1000})),
              testing::ElementsAre("0.01", "0.1", "1", "10", "100", "1000"));
  EXPECT_THAT(labels(axis_for("", Scale::log10, {1.1, 9})),
              testing::ElementsAre("1", "2", "5", "10"));
  EXPECT_LE(labels(axis_for("", Scale::log2, {1, 1 << 20})).size(), 9U);
  EXPECT_LE(labels(axis_for("", Scale::log10, {1e-20, 1e20})).size(), 10U);
  EXPECT_LE(labels(axis_for("", Scale::log10, {1e-6, 100}, 3)).size(), 4U);
}

TEST(Axis, PlacesValues) {
  const Axis linear{"", Scale::linear, 2, 4, {}};
  EXPECT_EQ(linear.place(3), 0.5);
  const Axis logarithmic{"", Scale::log10, 0.01, 100, {}};
  EXPECT_NEAR(logarithmic.place(1), 0.5, 1e-12);
}

TEST(Page, ShowsMasksWithoutAWrongPixel) {
  Accuracy a = accuracy();
  a.pairs.resize(1);
  a.pairs[0].geometry = {{1, 0.5, {0.1, 0, 0.1}}, {4, 0.7, {0.05, 0, 0.05}}};
  const std::string page = accuracy_page(a, Against::spp, "", "r.csv");
  const std::size_t chart = page.find("<title>Wrong mask pixels against rays");
  ASSERT_NE(chart, page.npos);
  EXPECT_EQ(occurrences(page.substr(chart, page.find("</svg>", chart) - chart), "class=\"mark"),
            2U);
}

TEST(Axis, HoldsOneValueAndNone) {
  EXPECT_THAT(labels(axis_for("", Scale::linear, {0, 0})),
              testing::ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));

  for (const Scale scale : {Scale::linear, Scale::log2, Scale::log10}) {
    const Axis one = axis_for("", scale, {3});
    EXPECT_GT(one.place(3), 0);
    EXPECT_LT(one.place(3), 1);
    EXPECT_FALSE(labels(axis_for("", scale, {})).empty());
  }
}

TEST(Svg, CoordinatesAreShort) {
  EXPECT_EQ(coordinate(1.0), "1");
  EXPECT_EQ(coordinate(-0.001), "0");
  EXPECT_EQ(coordinate(12.345), "12.35");
  EXPECT_EQ(short_number(0.02), "0.02");
  EXPECT_EQ(short_number(1500), "1500");
}

TEST(Chart, LeavesOutWhatALogarithmCannotShow) {
  Chart chart;
  chart.title = "t";
  chart.x_scale = Scale::log2;
  chart.y_scale = Scale::log10;
  chart.series.push_back({"s", 0, {{{1, 1, 1}, {0.5, -1, 2}}, {{2, 2, 2}, {0, 0, 0}}}, true, {}});
  const std::string svg = to_svg(chart);
  EXPECT_EQ(occurrences(svg, "class=\"mark"), 1U);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

/// (y of both ends) of every upright line of this class in the picture.
std::vector<std::pair<double, double>> upright_lines(const std::string& svg,
                                                     const std::string& css_class) {
  std::vector<std::pair<double, double>> found;
  const std::regex line("<line class=\"" + css_class +
                        "\" x1=\"([^\"]*)\" y1=\"([^\"]*)\" x2=\"([^\"]*)\" y2=\"([^\"]*)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), line), end; at != end; ++at)
    if ((*at)[1] == (*at)[3]) found.emplace_back(std::stod((*at)[2]), std::stod((*at)[4]));
  return found;
}

TEST(Chart, AnOpenEndGoesToTheFrameWithoutACap) {
  const double infinity = std::numeric_limits<double>::infinity();
  Chart chart;
  chart.series.push_back({"psnr", 0, {{{1, 1, 1}, {30, 28, infinity}}}, true, {}});
  chart.y_also = {20, 40};
  const std::string linear = to_svg(chart);
  ASSERT_EQ(upright_lines(linear, "bar s0").size(), 1U);
  EXPECT_EQ(upright_lines(linear, "bar s0")[0].first, 26);  // the frame's top
  EXPECT_EQ(occurrences(linear, "class=\"bar"), 2U);        // the bar and the cap of its lower end

  chart.y_scale = Scale::log10;
  chart.series[0].points = {{{1, 1, 1}, {30, 0, 35}}};
  const std::string logarithmic = to_svg(chart);
  ASSERT_EQ(upright_lines(logarithmic, "bar s0").size(), 1U);
  EXPECT_EQ(upright_lines(logarithmic, "bar s0")[0].second, 184);  // the x axis
  EXPECT_EQ(occurrences(logarithmic, "class=\"bar"), 2U);
}

TEST(Csv, AnOpenEndIsEmpty) {
  Accuracy a = accuracy();
  a.pairs[0].ladder[2].metrics[Metric::psnr_db] = {30, 28, std::numeric_limits<double>::infinity()};
  EXPECT_THAT(accuracy_csv(a), HasSubstr(",psnr_db,4,1,30,28,\n"));
}

TEST(Csv, IsThatOfRfc4180AndHoldsEveryNumber) {
  const std::string csv = accuracy_csv(accuracy());
  EXPECT_TRUE(csv.starts_with(
      "section,environment,material,image,name,metric,spp,seconds,value,low,high\n"));
  EXPECT_THAT(
      csv,
      HasSubstr("\nladder,\"attic, \"\"old\"\"\",steel,mug.ply/0,,error,4,1,0.25,0.1875,0.3125\n"));
  EXPECT_THAT(csv, HasSubstr("\nchoice,\"attic, \"\"old\"\"\",clay,mug.ply/0,effect light "
                             "<sun>,bias,,,0.5,0.25,0.75\n"));
  EXPECT_THAT(csv, HasSubstr(",0.05 *,seconds,,,25,22.5,27.5\n"));
}

TEST(Csv, Base64) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(Page, NeedsNothingElse) {
  const Accuracy a = accuracy();
  const std::string page = accuracy_page(a, Against::both, accuracy_csv(a), "mugs.csv");
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, HasSubstr("mugs &amp; more"));
  EXPECT_THAT(page, HasSubstr("no light &lt;sun&gt;"));
  EXPECT_THAT(page, HasSubstr("download=\"mugs.csv\" href=\"data:text/csv;charset=utf-8;base64,"));
}

TEST(Page, SaysWhichEffectsNoChoiceLeavesOut) {
  Accuracy a = accuracy();
  a.pairs[1].kept.push_back({{"light", "spot", true, "light lamp"}, "a reason"});
  EXPECT_THAT(accuracy_page(a, Against::both, "", "r.csv"),
              HasSubstr("<figcaption>Never left out with clay: light spot, since a reason."));
}

TEST(Page, SaysWhyThereIsNoTime) {
  Accuracy a = accuracy();
  a.pairs[0].targets.clear();
  a.pairs[0].no_targets = "a reason";
  a.pairs[1].targets = {{0.05, {100, 90, 110}, {25, 22.5, 27.5}, false},
                        {0.02, {100, 90, 110}, {25, 22.5, 27.5}, true},
                        {0.01, {100, 90, 110}, {25, 22.5, 27.5}, true}};
  const std::string page = accuracy_page(a, Against::both, "", "r.csv");
  EXPECT_THAT(page, HasSubstr("colspan=\"3\">not told: a reason</td></tr>"));
  EXPECT_EQ(occurrences(page, "<small>22.5 s to 27.5 s</small>"), 3U);
}

TEST(Page, NoChartHoldsMoreThanItCanTellApart) {
  Accuracy a = accuracy();
  for (int i = 0; i < 8; ++i)
    a.pairs.push_back(pair("m" + std::to_string(i)));
  const std::string page = accuracy_page(a, Against::spp, "", "r.csv");
  EXPECT_EQ(occurrences(page, "<p class=\"legend\">"), 2U * 3U);
}

TEST(Page, PlotsAgainstWhatWasAskedFor) {
  const Accuracy a = accuracy();
  const auto page = [&](Against against) { return accuracy_page(a, against, "", "r.csv"); };
  EXPECT_THAT(page(Against::spp), Not(HasSubstr("against time")));
  EXPECT_THAT(page(Against::minutes), Not(HasSubstr("against samples")));
  EXPECT_EQ(occurrences(page(Against::both), "<svg"),
            occurrences(page(Against::spp), "<svg") + 6 + 3);
}

}  // namespace
}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Every word of the grammar against its distribution, and draws against another program's.
#include "builder/recipe/distribution.h"

#include "builder/recipe/normal_numbers.h"
#include "tests/builder/recipe/statistics.h"
#include "tracer/base/canonical.h"
#include "tracer/base/files.h"
#include "tracer/base/hash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

namespace ds {
namespace {

constexpr int k_draws = 20'000;
constexpr double k_least_p = 1e-3;

Distribution read(const std::string& text, DrawnKind kind = DrawnKind::number) {
  std::string complaints;
  const auto found =
      read_distribution(parse_value(text), kind, {},
                        [&](const auto&, const auto& message) { complaints += message + "\n"; });
  EXPECT_EQ(complaints, "") << text;
  return found.value_or(Distribution{});
}

/// Of many views of a model.
std::vector<DrawnValue> draws(const std::string& text, DrawnKind kind = DrawnKind::number,
                              std::string_view key = "camera.fov_deg") {
  const Distribution distribution = read(text, kind);
  std::vector<DrawnValue> values;
  for (int i = 0; i < k_draws; ++i) {
    const std::string view = std::to_string(i);
    values.push_back(draw(distribution, key, {7, "mug.ply", view, std::uint64_t(i), 0}));
  }
  return values;
}

std::vector<double> each(const std::vector<DrawnValue>& values, double (*of)(const DrawnValue&)) {
  std::vector<double> numbers;
  for (const DrawnValue& value : values)
    numbers.push_back(of(value));
  return numbers;
}
double first(const DrawnValue& v) {
  return v[0];
}

double normal_share(double x) {
  return std::erfc(-x / std::sqrt(2.0)) / 2;
}

TEST(Distributions, OfNumbersAreWhatTheySay) {
  EXPECT_GT(
      ks_p(each(draws("{uniform = [35, 60]}"), first), [](double x) { return (x - 35) / 25; }),
      k_least_p);
  EXPECT_GT(ks_p(each(draws("{log_uniform = [0.02, 0.4]}"), first),
                 [](double x) { return std::log(x / 0.02) / std::log(20.0); }),
            k_least_p);
  const auto truncated = [](double mean, double sd, double a, double b) {
    return [=](double x) {
      const double low = normal_share((a - mean) / sd), high = normal_share((b - mean) / sd);
      return (normal_share((x - mean) / sd) - low) / (high - low);
    };
  };
  EXPECT_GT(
      ks_p(each(draws("{normal = [0, 4], within = [-10, 10]}"), first), truncated(0, 4, -10, 10)),
      k_least_p);
  EXPECT_GT(
      ks_p(each(draws("{normal = [1, 1], within = [0.5, 0.9]}"), first), truncated(1, 1, 0.5, 0.9)),
      k_least_p);
  // Far out in the upper tail the shares below lose their digits: those above are asked.
  EXPECT_GT(ks_p(each(draws("{normal = [0, 1], within = [8, 9]}"), first),
                 [](double x) {
                   const auto above = [](double y) { return std::erfc(y / std::sqrt(2.0)); };
                   return (above(8) - above(x)) / (above(8) - above(9));
                 }),
            k_least_p);
  EXPECT_GT(ks_p(each(draws("{spread = [10, 20]}"), first), [](double x) { return x / 10 - 1; }),
            k_least_p);
}

// At the least and the greatest number there is, every value is one that the distribution may give.
TEST(Distributions, StayInsideAtTheEndsOfTheirNumbers) {
  constexpr double k_rounding = 1e-12;
  const auto at_end = [](const std::string& text, DrawnKind kind, EvenNumberRule rule) {
    return draw(read(text, kind), "camera.fov_deg", {7, "mug.ply", "3", 3, 0, rule});
  };
  const EvenNumberRule ends[] = {
      [](std::uint64_t, std::string_view, std::string_view, int, int) { return 0.0; },
      [](std::uint64_t, std::string_view, std::string_view, int, int) { return 1 - 0x1p-53; }};
  for (const EvenNumberRule rule : ends) {
    for (const auto& [text, least, most] :
         {std::tuple{"{uniform = [35, 60]}", 35.0, 60.0},
          {"{log_uniform = [0.02, 0.4]}", 0.02, 0.4},
          {"{normal = [0, 4], within = [-10, 10]}", -10.0, 10.0},
          {"{normal = [0, 1], within = [8, 9]}", 8.0, 9.0},
          {"{choice = [1, 2, 3], weights = [1, 0, 1]}", 1.0, 3.0},
          {"{choice = [{uniform = [4, 5]}, {uniform = [4.5, 5]}]}", 4.0, 5.0},
          {"{cycle = [1, 2, 3]}", 1.0, 3.0},
          {"{spread = [10, 20]}", 10.0, 20.0}}) {
      const double value = at_end(text, DrawnKind::number, rule)[0];
      EXPECT_GE(value, least) << text;
      EXPECT_LE(value, most) << text;
      if (std::string_view(text).find("weights") != std::string_view::npos) {
        EXPECT_NE(value, 2);
      }
    }
    const double whole = at_end("{integer = [1, 6]}", DrawnKind::integer, rule)[0];
    EXPECT_EQ(whole, rule == ends[0] ? 1 : 6);
    const DrawnValue box = at_end("{box = [[0, 1, 2], [1, 2, 3]]}", DrawnKind::point, rule);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GE(box[i], double(i));
      EXPECT_LT(box[i], double(i) + 1);
    }
    for (const auto& [text, least, most] :
         {std::tuple{"{disc = [0.1, 0.3]}", 0.1, 0.3},
          {"{ball = 0.5}", 0.0, 0.5},
          {"{sphere = 0.5}", 0.5, 0.5},
          {"{shell = [0.2, 0.4], elevation_deg = [-90, 90]}", 0.2, 0.4}}) {
      const DrawnValue p = at_end(text, DrawnKind::point, rule);
      const double radius = std::hypot(p[0], p[1], p[2]);
      EXPECT_GE(radius, least - k_rounding) << text;
      EXPECT_LE(radius, most + k_rounding) << text;
    }
    const DrawnValue colour = at_end("{hsv = [[0, 1], [0, 1], [0, 1]]}", DrawnKind::colour, rule);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(colour[i] >= 0 && colour[i] <= 1) << colour[i];
    for (const char* text : {"{rotation = \"up\"}", "{rotation = \"any\"}"}) {
      const DrawnValue q = at_end(text, DrawnKind::rotation, rule);
      EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, k_rounding) << text;
    }
  }
}

TEST(Distributions, OfFewValuesAreWhatTheySay) {
  std::map<double, double> dice;
  for (const DrawnValue& value : draws("{integer = [1, 6]}", DrawnKind::integer))
    ++dice[value[0]];
  EXPECT_GT(chi_square_p(dice, {{1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}, {6, 1}}), k_least_p);
  std::map<double, double> weighted;
  for (const DrawnValue& value : draws("{choice = [0, 1, 2, 3], weights = [2, 1, 1, 0]}"))
    ++weighted[value[0]];
  EXPECT_GT(chi_square_p(weighted, {{0, 2}, {1, 1}, {2, 1}}), k_least_p);
  std::map<double, double> cycled;
  for (const DrawnValue& value : draws("{cycle = [1, 2, 2, 5]}"))
    ++cycled[value[0]];
  EXPECT_EQ(cycled, (std::map<double, double>{{1, 5000}, {2, 10000}, {5, 5000}}));
}

TEST(Distributions, OfPointsAreEvenInAreaVolumeAndSolidAngle) {
  const auto azimuth = [](const DrawnValue& v) {
    const double turn = std::atan2(v[1], v[0]) / (2 * std::numbers::pi);
    return turn < 0 ? turn + 1 : turn;
  };
  const auto share = [](double x) { return x; };
  const auto shell = draws("{shell = [0.2, 0.4], elevation_deg = [10, 60]}", DrawnKind::point);
  EXPECT_GT(ks_p(each(shell, [](const DrawnValue& v) { return std::hypot(v[0], v[1], v[2]); }),
                 [](double r) { return (r * r * r - 0.008) / 0.056; }),
            k_least_p);
  EXPECT_GT(
      ks_p(each(shell, [](const DrawnValue& v) { return v[2] / std::hypot(v[0], v[1], v[2]); }),
           [](double z) {
             const double low = std::sin(std::numbers::pi / 18),
                          high = std::sin(std::numbers::pi / 3);
             return (z - low) / (high - low);
           }),
      k_least_p);
  EXPECT_GT(ks_p(each(shell, azimuth), share), k_least_p);
  const auto ball = draws("{ball = 0.5, at = [1, 2, 3]}", DrawnKind::point);
  // A ball's height has the density 3/4 (1 - z^2).
  EXPECT_GT(ks_p(each(ball, [](const DrawnValue& v) { return (v[2] - 3) / 0.5; }),
                 [](double z) { return (2 + 3 * z - z * z * z) / 4; }),
            k_least_p);
  const auto sphere = draws("{sphere = 2}", DrawnKind::point);
  EXPECT_GT(ks_p(each(sphere, [](const DrawnValue& v) { return v[0]; }),
                 [](double x) { return (x + 2) / 4; }),
            k_least_p);
  for (const DrawnValue& v : sphere)
    EXPECT_NEAR(std::hypot(v[0], v[1], v[2]), 2, 1e-14);
  const auto disc = draws("{disc = [0.1, 0.3], azimuth_deg = [0, 360]}", DrawnKind::point);
  EXPECT_GT(ks_p(each(disc, [](const DrawnValue& v) { return std::hypot(v[0], v[1]); }),
                 [](double r) { return (r * r - 0.01) / 0.08; }),
            k_least_p);
  EXPECT_GT(ks_p(each(disc, azimuth), share), k_least_p);
  const auto box = draws("{box = [[0, 0, 1], [1, 2, 4]]}", DrawnKind::point);
  EXPECT_GT(ks_p(each(box, [](const DrawnValue& v) { return v[0]; }), share), k_least_p);
  EXPECT_GT(ks_p(each(box, [](const DrawnValue& v) { return v[2]; }),
                 [](double z) { return (z - 1) / 3; }),
            k_least_p);
}

TEST(Distributions, OfRotationsAreEven) {
  const auto any = draws("{rotation = \"any\"}", DrawnKind::rotation);
  // The angle of an even rotation has the density (1 - cos a) / pi.
  EXPECT_GT(ks_p(each(any, [](const DrawnValue& q) { return 2 * std::acos(std::fabs(q[0])); }),
                 [](double a) { return (a - std::sin(a)) / std::numbers::pi; }),
            k_least_p);
  // Where the z axis goes is even on the sphere.
  EXPECT_GT(ks_p(each(any, [](const DrawnValue& q) { return 1 - 2 * (q[1] * q[1] + q[2] * q[2]); }),
                 [](double z) { return (z + 1) / 2; }),
            k_least_p);
  const auto up = draws("{rotation = \"up\"}", DrawnKind::rotation);
  EXPECT_GT(ks_p(each(up, [](const DrawnValue& q) { return std::atan2(q[3], q[0]); }),
                 [](double half) { return half / std::numbers::pi; }),
            k_least_p);
}

TEST(Distributions, OfColoursAreEvenInHueSaturationAndValueOfSrgb) {
  const auto encoded = [](double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  };
  std::vector<double> hues, saturations, values;
  for (const DrawnValue& v :
       draws("{hsv = [[0.9, 1.2], [0.2, 0.9], [0.3, 0.8]]}", DrawnKind::colour)) {
    const double r = encoded(v[0]), g = encoded(v[1]), b = encoded(v[2]);
    const double most = std::max({r, g, b}), least = std::min({r, g, b}), range = most - least;
    // As Python's colorsys has it.
    const double rc = (most - r) / range, gc = (most - g) / range, bc = (most - b) / range;
    const double hue = (r == most ? bc - gc : g == most ? 2 + rc - bc : 4 + gc - rc) / 6;
    hues.push_back(std::fmod(hue + 1, 1) < 0.5 ? std::fmod(hue + 1, 1) + 1 : std::fmod(hue + 1, 1));
    saturations.push_back(range / most);
    values.push_back(most);
  }
  EXPECT_GT(ks_p(hues, [](double h) { return (h - 0.9) / 0.3; }), k_least_p);
  EXPECT_GT(ks_p(saturations, [](double s) { return (s - 0.2) / 0.7; }), k_least_p);
  EXPECT_GT(ks_p(values, [](double v) { return (v - 0.3) / 0.5; }), k_least_p);
}

TEST(Distributions, OfTwoKeysHaveNothingToDoWithEachOther) {
  const auto a = draws("{uniform = [0, 1]}", DrawnKind::number, "camera.fov_deg");
  const auto b = draws("{uniform = [0, 1]}", DrawnKind::number, "camera.roll_deg");
  double together = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    together += (a[i][0] - 0.5) * (b[i][0] - 0.5) * 12 / k_draws;
  EXPECT_LT(std::fabs(together), 3.3 / std::sqrt(k_draws));  // p = .001
}

// One more candidate takes images over and moves no other.
TEST(Distributions, AnotherCandidateMovesOnlyImagesThatNowShowIt) {
  const auto three = draws("{choice = [10, {uniform = [20, 30]}, 40]}");
  const auto four = draws("{choice = [{uniform = [50, 60]}, 10, {uniform = [20, 30]}, 40]}");
  std::map<double, double> taken;
  for (std::size_t i = 0; i < three.size(); ++i) {
    const bool other = four[i][0] >= 50;
    ++taken[other ? 1 : 0];
    if (!other) {
      EXPECT_EQ(four[i], three[i]);
    }
  }
  EXPECT_GT(chi_square_p(taken, {{0, 3}, {1, 1}}), k_least_p);
  // What is inside a candidate is even too, though chance chose it.
  std::vector<double> inside;
  for (const DrawnValue& value : four)
    if (value[0] > 15 && value[0] < 35) inside.push_back(value[0]);
  EXPECT_GT(ks_p(inside, [](double x) { return (x - 20) / 10; }), k_least_p);
}

TEST(Distributions, MoreViewsLeaveTheFirstOnesAndStayEven) {
  const Distribution spread = read("{spread = [0, 1]}");
  std::vector<double> places;
  for (std::uint64_t i = 0; i < 13; ++i) {
    const std::string view = std::to_string(i);
    places.push_back(draw(spread, "camera.roll_deg", {0, "mug.ply", view, i, 0})[0]);
  }
  std::sort(places.begin(), places.end());
  // Multiples of the golden section part a circle in gaps of three lengths (Steinhaus): of 13 points,
  // a Fibonacci number, none is wider than phi^-5 (0.0902) nor narrower than phi^-6 (0.0557).
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double gap =
        i + 1 < places.size() ? places[i + 1] - places[i] : places.front() + 1 - places.back();
    EXPECT_LT(gap, 0.0903);
    EXPECT_GT(gap, 0.0556);
  }
}

TEST(Distributions, KeepTheirBounds) {
  struct Ends {
    const char* text;
    double least, most;
    bool most_included;
  };
  // A key whose number is 0, and one whose number is next to 1, cannot be found: words are given
  // them by their widths instead.
  for (const Ends& ends :
       {Ends{"{uniform = [35, 60]}", 35, 60, false},
        Ends{"{uniform = [1, 1.0000000000000002]}", 1, 1.0000000000000002, false},
        Ends{"{log_uniform = [1, 1.0000000000000004]}", 1, 1.0000000000000004, false},
        Ends{"{normal = [0, 1], within = [-0.5, 0.25]}", -0.5, 0.25, true},
        Ends{"{normal = [0, 1e-9], within = [-1e-12, 1e-12]}", -1e-12, 1e-12, true},
        Ends{"{uniform = [3, 3]}", 3, 3, true}, Ends{"{log_uniform = [3, 3]}", 3, 3, true},
        Ends{"{normal = [3, 0], within = [0, 5]}", 3, 3, true},
        Ends{"{spread = [3, 3]}", 3, 3, true}})
    for (const DrawnValue& value : draws(ends.text)) {
      ASSERT_GE(value[0], ends.least) << ends.text;
      if (ends.most_included)
        ASSERT_LE(value[0], ends.most) << ends.text;
      else
        ASSERT_LT(value[0], ends.most) << ends.text;
    }
}

TEST(NormalNumbers, AreThoseOfTheLibrary) {
  for (double x = -37; x <= 8; x += 0.0625) {
    const double wanted = std::erfc(-x / std::sqrt(2.0)) / 2;
    EXPECT_NEAR(normal_below(x) / wanted, 1, 2e-13) << x;
    if (x < 0) {  // above it the share, next to 1, does not tell x as exactly
      EXPECT_EQ(normal_at(1 - std::ldexp(1, -20)), -normal_at(std::ldexp(1, -20)));
      EXPECT_NEAR(normal_at(normal_below(x)), x, 1e-13 * std::max(1.0, std::fabs(x))) << x;
    }
  }
  EXPECT_EQ(normal_below(0), 0.5);
  EXPECT_EQ(normal_at(0.5), 0);
}

TEST(Draws, AreThoseOfAnotherProgram) {
  std::istringstream lines(read_text_file(DS_SOURCE_DIR "/tests/builder/recipe/golden_draws.txt"));
  CanonicalText bits;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, '|');)
      fields.push_back(field);
    ASSERT_EQ(fields.size(), 8U) << line;
    const std::string &text = fields[0], &key = fields[1], &view = fields[4];
    const DrawnKind kind = key == "models.turn"       ? DrawnKind::rotation
                           : key.ends_with("quality") ? DrawnKind::integer
                           : key.ends_with("position_m") || key.ends_with("place_m")
                               ? DrawnKind::point
                               : DrawnKind::number;
    const Distribution distribution = read(text, kind);
    const DrawnFor of{std::stoull(fields[2]), fields[3], view, std::stoull(view),
                      std::stoi(fields[5])};
    std::string identity = fields[3];
    if (distribution.per == DrawnPer::dataset) identity.clear();
    if (distribution.per == DrawnPer::view && !distribution.word->by_view) identity += "/" + view;
    EXPECT_EQ(even_number(of.seed, identity, key, 0, of.attempt), std::stod(fields[6])) << line;
    const DrawnValue value = draw(distribution, key, of);
    std::istringstream numbers(fields[7]);
    double wanted = 0;
    for (std::size_t i = 0; numbers >> wanted; ++i) {
      EXPECT_NEAR(value[i], wanted, 2e-14 * std::max(1.0, std::fabs(wanted))) << line;
      bits.add(key, value[i]);
    }
  }
  EXPECT_EQ(count, 40);
  // To the last bit, which another program's logarithm and cosine do not tell: a change of it makes
  // every dataset with a distribution stale.
  EXPECT_EQ(hash_text(bits.text()).hex(), "0054cdb9e3d1f9956b6e55ba8890dca8");
}

}  // namespace
}  // namespace ds

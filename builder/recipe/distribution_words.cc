// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/distribution.h"
#include "builder/recipe/normal_numbers.h"
#include "tracer/base/degrees.h"
#include "tracer/base/error.h"
#include "tracer/scene/sdl_math.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

// (sqrt(5) - 1) / 2: multiples of it, less their whole part, divide [0, 1) ever more evenly.
constexpr double k_golden_share = 0.6180339887498949;

/// A place between a and b; b only where it is a.
double between(double a, double b, double share) {
  const double x = a + share * (b - a);
  return x < b || a == b ? x : std::nextafter(b, a);
}

DrawnValue uniform(const Distribution& d, const EvenNumbers& u) {
  return {between(d.numbers[0], d.numbers[1], u(0))};
}

std::string check_positive(Distribution& d) {
  return d.numbers[0] > 0 ? "" : "wants two numbers above 0";
}
DrawnValue log_uniform(const Distribution& d, const EvenNumbers& u) {
  const double a = d.numbers[0], b = d.numbers[1];
  if (a == b) return {a};
  const double low = portable::log(a);
  const double x = portable::exp(low + u(0) * (portable::log(b) - low));
  return {std::clamp(x, a, std::nextafter(b, a))};
}

/// In the upper half the shares below the bounds are next to 1 and lose digits: there the mirror image
/// is drawn.
bool is_mirrored(const Distribution& d) {
  return d.within[0] > d.numbers[0];
}
std::string check_normal(Distribution& d) {
  constexpr double k_most_deviations = 12;
  const double mean = d.numbers[0], deviation = d.numbers[1];
  if (deviation < 0)
    return fmt::format("wants a deviation that is not negative, got {}", deviation);
  if (d.within[0] > mean + k_most_deviations * deviation ||
      d.within[1] < mean - k_most_deviations * deviation)
    return fmt::format("must have within nearer than {} deviations to the mean, got [{}, {}]",
                       k_most_deviations, d.within[0], d.within[1]);
  if (deviation == 0) return "";
  const double low = (d.within[0] - mean) / deviation, high = (d.within[1] - mean) / deviation;
  d.shares = is_mirrored(d) ? std::array{normal_below(-high), normal_below(-low)}
                            : std::array{normal_below(low), normal_below(high)};
  return "";
}
DrawnValue normal(const Distribution& d, const EvenNumbers& u) {
  const double mean = d.numbers[0], deviation = d.numbers[1];
  if (deviation == 0) return {mean};
  const double z = normal_at(d.shares[0] + u(0) * (d.shares[1] - d.shares[0]));
  // Rounding alone could lead out of the bounds.
  return {std::clamp(mean + deviation * (is_mirrored(d) ? -z : z), d.within[0], d.within[1])};
}

std::string check_whole(Distribution& d) {
  const auto is_whole = [](double x) { return x == std::floor(x) && std::fabs(x) <= 0x1p52; };
  return is_whole(d.numbers[0]) && is_whole(d.numbers[1]) ? "" : "wants two whole numbers";
}
DrawnValue whole_number(const Distribution& d, const EvenNumbers& u) {
  const double a = d.numbers[0], b = d.numbers[1];
  return {std::min(b, a + std::floor(u(0) * (b - a + 1)))};
}

DrawnValue value_of(const Distribution& candidate, const EvenNumbers& u) {
  if (candidate.word != nullptr) return candidate.word->draw(candidate, u);
  DrawnValue value{};
  std::copy(candidate.numbers.begin(), candidate.numbers.end(), value.begin());
  return value;
}

/// The least of exponential times, each candidate's at a rate of its weight: adding one moves only
/// the images that now show it.
DrawnValue candidate(const Distribution& d, const EvenNumbers& u) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < d.candidates.size(); ++i) {
    const double weight = d.weights.empty() ? 1 : d.weights[i];
    if (weight == 0) continue;
    const std::string key = fmt::format("{}[{}]", u.key, d.names[i]);
    const double time = -portable::log(1 - EvenNumbers{u.of, u.identity, key}(0)) / weight;
    if (time < least) {
      least = time;
      best = i;
    }
  }
  const std::string key = fmt::format("{}[{}]", u.key, d.names[best]);
  return value_of(d.candidates[best], {u.of, u.identity, key, 1});  // number 0 chose it
}

DrawnValue cycle(const Distribution& d, const EvenNumbers& u) {
  const auto count = static_cast<std::uint64_t>(d.candidates.size());
  const auto start = static_cast<std::uint64_t>(u(0) * static_cast<double>(count));
  return value_of(d.candidates[(start + u.of.view_number) % count], u);
}

DrawnValue spread(const Distribution& d, const EvenNumbers& u) {
  const double x = u(0) + static_cast<double>(u.of.view_number) * k_golden_share;
  return {between(d.numbers[0], d.numbers[1], x - std::floor(x))};
}

DrawnValue box(const Distribution& d, const EvenNumbers& u) {
  DrawnValue point{};
  for (std::size_t i = 0; i < 3; ++i)
    point[i] = between(d.numbers[i], d.numbers[i + 3], u(static_cast<int>(i)));
  return point;
}
std::string check_box(Distribution& d) {
  for (std::size_t i = 0; i < 3; ++i)
    if (d.numbers[i] > d.numbers[i + 3]) return "wants the corner of the lesser coordinates first";
  return "";
}

double azimuth_of(const Distribution& d, double share) {
  return between(d.azimuth_deg[0], d.azimuth_deg[1], share);
}

DrawnValue disc(const Distribution& d, const EvenNumbers& u) {
  const double inner = d.numbers[0], outer = d.numbers[1];
  const double radius = std::sqrt(between(inner * inner, outer * outer, u(0)));
  const double azimuth = azimuth_of(d, u(2));
  return {d.at[0] + radius * cos_deg(azimuth), d.at[1] + radius * sin_deg(azimuth), d.at[2]};
}

double cube_root(double x) {
  if (x == 0) return 0;
  const double root = portable::exp(portable::log(x) / 3);
  return root - (root * root * root - x) / (3 * root * root);
}

/// Even in solid angle between two elevations.
DrawnValue at_radius(double radius, const Distribution& d, const EvenNumbers& u) {
  const double z = between(sin_deg(d.elevation_deg[0]), sin_deg(d.elevation_deg[1]), u(1));
  const double across = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
  const double azimuth = azimuth_of(d, u(2));
  return {d.at[0] + radius * across * cos_deg(azimuth),
          d.at[1] + radius * across * sin_deg(azimuth), d.at[2] + radius * z};
}

DrawnValue sphere(const Distribution& d, const EvenNumbers& u) {
  return at_radius(d.numbers[1], d, u);
}

/// Even in volume between two radii.
DrawnValue shell(const Distribution& d, const EvenNumbers& u) {
  const double inner = d.numbers[0], outer = d.numbers[1];
  const double cube = between(inner * inner * inner, outer * outer * outer, u(0));
  return at_radius(inner == outer ? outer : cube_root(cube), d, u);
}
std::string check_radii(Distribution& d) {
  return d.numbers[0] >= 0 ? "" : "wants two radii >= 0";
}

/// "up" is 1, "any" 2. Shoemake, Uniform Random Rotations (Graphics Gems III, 1992).
DrawnValue rotation(const Distribution& d, const EvenNumbers& u) {
  if (d.numbers[0] == 1) return {cos_deg(180 * u(0)), 0, 0, sin_deg(180 * u(0))};
  const double share = u(0), first = 360 * u(1), second = 360 * u(2);
  const double a = std::sqrt(1 - share), b = std::sqrt(share);
  return {b * cos_deg(second), a * sin_deg(first), a * cos_deg(first), b * sin_deg(second)};
}

/// sRGB's curve (IEC 61966-2-1): what hue, saturation and value are of.
double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}
DrawnValue hsv(const Distribution& d, const EvenNumbers& u) {
  const double hue = between(d.numbers[0], d.numbers[1], u(0));
  const double saturation = between(d.numbers[2], d.numbers[3], u(1));
  const double value = between(d.numbers[4], d.numbers[5], u(2));
  DrawnValue rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Red, green and blue have their peaks at 0, 1/3 and 2/3 of the circle.
    const double from_peak = hue - static_cast<double>(i) / 3;
    const double share = std::fabs(from_peak - std::floor(from_peak) - 0.5) * 6 - 1;
    rgb[i] = linear(value * (1 - saturation * (1 - std::clamp(share, 0.0, 1.0))));
  }
  return rgb;
}
std::string check_hsv(Distribution& d) {
  const bool shares = std::all_of(d.numbers.begin() + 2, d.numbers.end(),
                                  [](double x) { return x >= 0 && x <= 1; });
  return shares && d.numbers[1] - d.numbers[0] <= 1
             ? ""
             : "wants saturations and values in [0, 1] and hues not more than 1 apart";
}

constexpr DrawnKind k_numbers[] = {DrawnKind::number};
constexpr DrawnKind k_integers[] = {DrawnKind::integer};
constexpr DrawnKind k_even[] = {DrawnKind::number, DrawnKind::integer, DrawnKind::point,
                                DrawnKind::colour, DrawnKind::rotation};
constexpr DrawnKind k_points[] = {DrawnKind::point};
constexpr DrawnKind k_colours[] = {DrawnKind::colour};
constexpr DrawnKind k_rotations[] = {DrawnKind::rotation};

constexpr std::string_view k_per[] = {"per"};
constexpr std::string_view k_within[] = {"within!", "per"};
constexpr std::string_view k_weights[] = {"weights", "per"};
constexpr std::string_view k_on_disc[] = {"azimuth_deg", "at", "per"};
constexpr std::string_view k_on_sphere[] = {"elevation_deg", "azimuth_deg", "at", "per"};

constexpr DistributionWord k_words[] = {
    {"uniform", k_numbers, WordShape::range, k_per, "evenly, the least included and the most not",
     nullptr, uniform},
    {"log_uniform", k_numbers, WordShape::range, k_per, "evenly in the logarithm", check_positive,
     log_uniform},
    {"normal", k_numbers, WordShape::parameters, k_within,
     "normally, given that it lies within bounds, which must be given", check_normal, normal},
    {"integer", k_integers, WordShape::range, k_per, "a whole number, both ends included",
     check_whole, whole_number},
    {"choice", k_even, WordShape::candidates, k_weights,
     "one of these, which may be distributions; one more changes only the images that now show it",
     nullptr, candidate},
    {"cycle",
     k_even,
     WordShape::candidates,
     {},
     "one behind the other from view to view, from a start of each model's own",
     nullptr,
     cycle,
     true},
    {"spread",
     k_numbers,
     WordShape::range,
     {},
     "even over the views of each model: more views leave the first ones as they are",
     nullptr,
     spread,
     true},
    {"box", k_points, WordShape::box, k_per, "evenly in the box between two corners", check_box,
     box},
    {"disc", k_points, WordShape::radii, k_on_disc,
     "evenly in area on a level disc, or on a ring between two radii", nullptr, disc},
    {"ball", k_points, WordShape::radius, k_on_sphere, "evenly in volume in a ball", nullptr,
     shell},
    {"sphere", k_points, WordShape::radius, k_on_sphere, "evenly in area on a sphere", nullptr,
     sphere},
    {"shell", k_points, WordShape::range, k_on_sphere, "evenly in volume between two spheres",
     check_radii, shell},
    {"hsv", k_colours, WordShape::hsv, k_per,
     "ranges of hue (which may pass 1 on to 0), saturation and value of sRGB; the value is linear "
     "Rec.709",
     check_hsv, hsv},
    {"rotation", k_rotations, WordShape::turn, k_per,
     "\"up\": by any angle about the vertical; \"any\": evenly over all rotations", nullptr,
     rotation},
};

}  // namespace

std::span<const DistributionWord> distribution_words() {
  return k_words;
}

const DistributionWord* find_word(std::string_view name) {
  const auto at = std::find_if(std::begin(k_words), std::end(k_words),
                               [&](const DistributionWord& word) { return word.name == name; });
  return at == std::end(k_words) ? nullptr : &*at;
}

bool may_draw(const DistributionWord& word, DrawnKind kind) {
  return std::find(word.kinds.begin(), word.kinds.end(), kind) != word.kinds.end();
}

std::string_view name_of(DrawnKind kind) {
  switch (kind) {
    case DrawnKind::number:
      return "number";
    case DrawnKind::integer:
      return "integer";
    case DrawnKind::point:
      return "point";
    case DrawnKind::colour:
      return "colour";
    case DrawnKind::rotation:
      return "rotation";
  }
  return "";
}

std::size_t width_of(DrawnKind kind) {
  switch (kind) {
    case DrawnKind::number:
    case DrawnKind::integer:
      return 1;
    case DrawnKind::point:
    case DrawnKind::colour:
      return 3;
    case DrawnKind::rotation:
      return 4;
  }
  return 0;
}

DrawnValue draw(const Distribution& distribution, std::string_view key, const DrawnFor& of) {
  std::string identity;
  // What goes from view to view begins somewhere for each model.
  const bool by_view = distribution.word != nullptr && distribution.word->by_view;
  const DrawnPer per = by_view ? DrawnPer::model : distribution.per;
  if (per != DrawnPer::dataset) identity = of.model;
  if (per == DrawnPer::view) (identity += '/') += of.view;
  return value_of(distribution, {of, identity, key});
}

}  // namespace ds

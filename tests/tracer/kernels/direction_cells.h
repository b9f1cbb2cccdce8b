// SPDX-License-Identifier: Apache-2.0
// A chi-square test's cells on the sphere of directions, made to fit where samples lie, however narrow
// the lobes: each holds as many of a first set of samples, and a second set is counted in them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace ds {

/// Equal-area coordinates of a direction: its part t along a horizontal axis, and the angle phi around
/// that, 0 to pi above the surface. What lies in the plane across the axis is at their equator.
struct PlacedDirection {
  double t, phi;
};

class DirectionCells {
 public:
  static constexpr std::size_t k_cells = 40;

  explicit DirectionCells(std::vector<PlacedDirection> places) {
    constexpr double pi = std::numbers::pi;
    const auto below =
        std::partition(places.begin(), places.end(), [](const auto& p) { return p.phi < 0; });
    const std::span all(places);
    const auto count = static_cast<std::size_t>(below - places.begin());
    split({{-1, -pi}, {1, 0}}, all.first(count));
    upper_root_ = nodes_.size();
    split({{-1, 0}, {1, pi}}, all.subspan(count));
  }

  std::size_t cell(const PlacedDirection& at) const {
    std::size_t node = at.phi < 0 ? 0 : upper_root_;
    while (nodes_[node].side != nullptr)
      node = at.*nodes_[node].side < nodes_[node].at ? node + 1 : nodes_[node].other;
    return cell_of(nodes_[node].other);
  }
  /// The lesser extent of those places whose leaf is the narrowest but for a tenth of all.
  double narrow_width() const {
    std::vector<double> widths;
    for (const Leaf& leaf : leaves_)
      widths.push_back(
          std::min(leaf.inner.high.t - leaf.inner.low.t, leaf.inner.high.phi - leaf.inner.low.phi));
    const auto tenth = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 10);
    std::nth_element(widths.begin(), tenth, widths.end());
    return *tenth;
  }
  /// Integral of `pdf`, a function of a PlacedDirection, over each cell.
  template <typename Pdf>
  std::vector<double> integrals(const Pdf& pdf) const {
    std::vector<double> sums(k_cells);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      // Where the places are, and around that: in a wide leaf a rule's nodes would miss a narrow lobe.
      const auto& [box, inner] = leaves_[i];
      for (const Box& part : {inner, Box{box.low, {inner.low.t, box.high.phi}},
                              Box{{inner.high.t, box.low.phi}, box.high},
                              Box{{inner.low.t, box.low.phi}, {inner.high.t, inner.low.phi}},
                              Box{{inner.low.t, inner.high.phi}, {inner.high.t, box.high.phi}}})
        sums[cell_of(i)] += refined(part, gauss(part, pdf), pdf, 0);
    }
    return sums;
  }

 private:
  struct Box {
    PlacedDirection low, high;
  };
  struct Leaf {
    Box box, inner;  ///< inner: around its places, with a margin
  };
  /// The lower part follows it, the upper one is `other`; of a leaf, without a side, that is its number.
  struct Node {
    double PlacedDirection::*side;
    double at;
    std::size_t other;
  };
  static constexpr std::size_t k_most_places = 24;

  std::size_t cell_of(std::size_t leaf) const { return leaf * k_cells / leaves_.size(); }

  void add_leaf(const Box& box, std::span<const PlacedDirection> places) {
    Box inner{box.high, box.low};
    for (const PlacedDirection& p : places) {
      inner.low = {std::min(inner.low.t, p.t), std::min(inner.low.phi, p.phi)};
      inner.high = {std::max(inner.high.t, p.t), std::max(inner.high.phi, p.phi)};
    }
    // Beyond as much again on each side little of what the lobe has there is left.
    const double t = 1.5 * (inner.high.t - inner.low.t),
                 phi = 1.5 * (inner.high.phi - inner.low.phi);
    inner = {
        {std::max(box.low.t, inner.low.t - t), std::max(box.low.phi, inner.low.phi - phi)},
        {std::min(box.high.t, inner.high.t + t), std::min(box.high.phi, inner.high.phi + phi)}};
    nodes_.push_back({nullptr, 0, leaves_.size()});
    leaves_.push_back({box, places.empty() ? box : inner});
  }

  /// Between the quarters of the places.
  static double spread(std::span<PlacedDirection> places, double PlacedDirection::*side) {
    std::vector<double> values;
    for (const PlacedDirection& p : places)
      values.push_back(p.*side);
    const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
    std::nth_element(values.begin(), values.begin() + quarter, values.end());
    const double low = values[static_cast<std::size_t>(quarter)];
    std::nth_element(values.begin(), values.end() - 1 - quarter, values.end());
    return *(values.end() - 1 - quarter) - low;
  }

  void split(const Box& box, std::span<PlacedDirection> places) {
    if (places.size() <= k_most_places) return add_leaf(box, places);
    double PlacedDirection::*const side =
        spread(places, &PlacedDirection::t) > spread(places, &PlacedDirection::phi)
            ? &PlacedDirection::t
            : &PlacedDirection::phi;
    const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    std::nth_element(places.begin(), middle, places.end(),
                     [&](const auto& a, const auto& b) { return a.*side < b.*side; });
    const double at = (*middle).*side;
    if (!(at > box.low.*side && at < box.high.*side)) return add_leaf(box, places);  // all are one
    Box lower = box, upper = box;
    lower.high.*side = at;
    upper.low.*side = at;
    const std::size_t node = nodes_.size();
    nodes_.push_back({side, at, 0});
    const auto count = static_cast<std::size_t>(middle - places.begin());
    split(lower, places.first(count));
    nodes_[node].other = nodes_.size();
    split(upper, places.subspan(count));
  }

  /// Gauss's rule of 3 x 3 nodes.
  template <typename Pdf>
  static double gauss(const Box& box, const Pdf& pdf) {
    constexpr std::array nodes{-0.7745966692414834, 0.0, 0.7745966692414834};
    constexpr std::array weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double width = box.high.t - box.low.t, height = box.high.phi - box.low.phi;
    if (!(width * height > 0)) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        sum += weights[i] * weights[j] *
               double{pdf(PlacedDirection{box.low.t + width * (1 + nodes[i]) / 2,
                                          box.low.phi + height * (1 + nodes[j]) / 2})};
    return sum * width * height;
  }
  template <typename Pdf>
  static double refined(const Box& box, double whole, const Pdf& pdf, int depth) {
    const double t = (box.low.t + box.high.t) / 2, phi = (box.low.phi + box.high.phi) / 2;
    const std::array parts{Box{box.low, {t, phi}}, Box{{t, box.low.phi}, {box.high.t, phi}},
                           Box{{box.low.t, phi}, {t, box.high.phi}}, Box{{t, phi}, box.high}};
    std::array<double, 4> sums{};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += sums[i] = gauss(parts[i], pdf);
    constexpr int k_deepest = 8;
    if (std::fabs(sum - whole) < 5e-6 || depth == k_deepest) return sum;
    sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += refined(parts[i], sums[i], pdf, depth + 1);
    return sum;
  }

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
  std::size_t upper_root_ = 0;
};

}  // namespace ds

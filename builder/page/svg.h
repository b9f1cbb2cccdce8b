// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Text as it may stand in HTML, in an attribute too: & < > " escaped, control characters dropped.
std::string escaped(std::string_view text);

/// A coordinate: at most two decimals, no locale, no "-0".
std::string coordinate(double value);

enum class Anchor { start, middle, end };

/// One picture of an SVG, in the text's own units. Colours are the page's: what is drawn names
/// classes, page_style.h says how they look in light, in dark and in print.
class Svg {
 public:
  /// `title` is what a screen reader says and what a pointer over the picture shows.
  Svg(double width, double height, std::string_view title);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class);
  void polyline(const std::vector<std::pair<double, double>>& points, std::string_view css_class);
  void rectangle(double x, double y, double width, double height, std::string_view css_class);
  void text(double x, double y, Anchor anchor, std::string_view css_class, std::string_view words);
  /// Reads upwards around its anchor.
  void text_upwards(double x, double y, std::string_view css_class, std::string_view words);
  /// One of six shapes, told apart without colour: disc, square, triangle, diamond, cross, ring.
  void marker(double x, double y, int shape, std::string_view css_class, std::string_view tip);
  /// The whole element.
  std::string str() const;

 private:
  std::string head_, body_;
};

}  // namespace ds

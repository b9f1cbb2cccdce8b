// SPDX-License-Identifier: Apache-2.0
#include "builder/page/svg.h"

#include <fmt/format.h>

#include <cmath>

namespace ds {
namespace {

const char* name_of(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}

/// The outline of a marker about the origin, 7 units across.
std::string shape_path(int shape) {
  switch (shape % 6) {
    case 1:
      return "M-3-3H3V3H-3Z";
    case 2:
      return "M0-4L3.8 2.8H-3.8Z";
    case 3:
      return "M0-4.2L4.2 0 0 4.2-4.2 0Z";
    case 4:
      return "M-3.4-2L-2-3.4 0-1.4 2-3.4 3.4-2 1.4 0 3.4 2 2 3.4 0 1.4-2 3.4-3.4 2-1.4 0Z";
    case 5:
      return "M-3.6 0A3.6 3.6 0 1 0 3.6 0 3.6 3.6 0 1 0-3.6 0ZM-1.6 0A1.6 1.6 0 1 1 1.6 0 1.6 1.6 "
             "0 1 1-1.6 0Z";
    default:
      return "M-3.4 0A3.4 3.4 0 1 0 3.4 0 3.4 3.4 0 1 0-3.4 0Z";
  }
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t')
      out += c;
  }
  return out;
}

std::string coordinate(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

Svg::Svg(double width, double height, std::string_view title)
    : head_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{0}\" "
                        "height=\"{1}\" viewBox=\"0 0 {0} {1}\"><title>{2}</title>",
                        coordinate(width), coordinate(height), escaped(title))) {}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  body_ += fmt::format("<line class=\"{}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>", css_class,
                       coordinate(x1), coordinate(y1), coordinate(x2), coordinate(y2));
}

void Svg::polyline(const std::vector<std::pair<double, double>>& points,
                   std::string_view css_class) {
  body_ += fmt::format("<polyline class=\"{}\" points=\"", css_class);
  for (const auto& [x, y] : points)
    body_ += coordinate(x) + "," + coordinate(y) + " ";
  body_ += "\"/>";
}

void Svg::rectangle(double x, double y, double width, double height, std::string_view css_class) {
  body_ +=
      fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", css_class,
                  coordinate(x), coordinate(y), coordinate(width), coordinate(height));
}

void Svg::text(double x, double y, Anchor anchor, std::string_view css_class,
               std::string_view words) {
  body_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>",
                       css_class, coordinate(x), coordinate(y), name_of(anchor), escaped(words));
}

void Svg::text_upwards(double x, double y, std::string_view css_class, std::string_view words) {
  body_ += fmt::format(
      "<text class=\"{}\" transform=\"translate({} {}) rotate(-90)\" "
      "text-anchor=\"middle\">{}</text>",
      css_class, coordinate(x), coordinate(y), escaped(words));
}

void Svg::marker(double x, double y, int shape, std::string_view css_class, std::string_view tip) {
  body_ += fmt::format("<path class=\"{}\" transform=\"translate({} {})\" d=\"{}\">", css_class,
                       coordinate(x), coordinate(y), shape_path(shape));
  if (!tip.empty()) body_ += "<title>" + escaped(tip) + "</title>";
  body_ += "</path>";
}

std::string Svg::str() const {
  return head_ + body_ + "</svg>";
}

}  // namespace ds

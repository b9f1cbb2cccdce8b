// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace ds {
namespace {

using nlohmann::json;

constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view k_draw = "draw.", k_classes = "classes.";

struct Known {
  std::string_view key, label, unit;
};
/// In the order they are shown; draws follow.
constexpr std::array k_known = {
    Known{"class", "class", ""},
    Known{"split", "split", ""},
    Known{"model", "model", ""},
    Known{"material", "material", ""},
    Known{"environment", "environment", ""},
    Known{"view", "view", ""},
    Known{"error", "relative error", "share"},
    Known{"samples", "samples", "a pixel"},
    Known{"rejected", "rejected samples", ""},
    Known{"area", "mask area", "share"},
    Known{"visible", "visible fraction", "share"},
    Known{"truncation", "truncation", "share"},
    Known{"occlusion", "occlusion", "share"},
    Known{"border", "mask on the border", "pixels"},
    Known{"objects", "distractors", ""},
    Known{"box_x", "box centre x", "share"},
    Known{"box_y", "box centre y", "share"},
    Known{"brightness", "brightness", "share"},
    Known{"contrast", "contrast", "share"},
    Known{"azimuth", "camera azimuth", "degrees"},
    Known{"elevation", "camera elevation", "degrees"},
    Known{"distance", "camera distance", "m"},
    Known{"fov", "field of view", "degrees"},
    Known{"width", "width", "pixels"},
    Known{"height", "height", "pixels"},
};

std::string text_of(const json& line, const char* key) {
  const auto at = line.find(key);
  return at != line.end() && at->is_string() ? at->get<std::string>() : "";
}

std::optional<double> number_of(const json& object, const char* key) {
  const auto at = object.find(key);
  if (at == object.end() || !at->is_number()) return std::nullopt;
  return at->get<double>();
}

/// A field of an object that may not be there.
std::optional<double> number_of(const json& line, const char* object, const char* key) {
  const auto at = line.find(object);
  if (at == line.end() || !at->is_object()) return std::nullopt;
  return number_of(*at, key);
}

double degrees(double radians) {
  return radians * 57.295779513082323;
}

/// To tenths: what is left of libraries' differences in the last bits.
double tenths(double value) {
  return std::round(value * 10) / 10 + 0.0;  // no -0
}

using Matrix = std::array<std::array<double, 4>, 4>;

std::optional<Matrix> matrix_of(const json& line, const char* key) {
  const auto rows = line.find(key);
  if (rows == line.end() || !rows->is_array() || rows->size() != 4) return std::nullopt;
  Matrix matrix{};
  for (std::size_t i = 0; i < 4; ++i) {
    const json& row = (*rows)[i];
    if (!row.is_array() || row.size() != 4) return std::nullopt;
    for (std::size_t j = 0; j < 4; ++j) {
      if (!row[j].is_number()) return std::nullopt;
      matrix[i][j] = row[j].get<double>();
    }
  }
  return matrix;
}

/// Of the model's box in the world; its origin where nobody knows.
std::array<double, 3> model_middle(const json& line) {
  std::array<double, 3> middle{};
  const auto box = line.find("box_m");
  if (box == line.end() || !box->is_array() || box->size() != 2) return middle;
  for (std::size_t i = 0; i < 3; ++i)
    for (const json& corner : *box)
      if (corner.is_array() && corner.size() == 3 && corner[i].is_number())
        middle[i] += corner[i].get<double>() / 2;
  return middle;
}

}  // namespace

namespace {

/// The digits that `text` begins with, without zeros before them; taken off it.
std::string_view take_number(std::string_view& text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end]))
    ++end;
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  const std::size_t first = std::min(number.find_first_not_of('0'), number.size());
  return number.substr(first);
}

}  // namespace

bool as_people_count(const std::string& a, const std::string& b) {
  std::string_view x = a, y = b;
  while (!x.empty() && !y.empty()) {
    const std::size_t x_size = x.size(), y_size = y.size();
    const std::string_view m = take_number(x), n = take_number(y);
    const bool both = x.size() < x_size && y.size() < y_size;
    if (both) {
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
      continue;
    }
    // One of them is no number: as texts.
    x = std::string_view(a).substr(a.size() - x_size);
    y = std::string_view(b).substr(b.size() - y_size);
    if (x.front() != y.front()) return x.front() < y.front();
    x.remove_prefix(1);
    y.remove_prefix(1);
  }
  return x.size() != y.size() ? x.size() < y.size() : a < b;
}

std::string short_json_number(double value) {
  if (!std::isfinite(value)) return "null";
  return fmt::format("{:.6g}", value + 0.0);
}

GalleryColumn& GalleryColumns::column(const std::string& key, GalleryColumn::Type type) {
  const auto [at, is_new] = columns_.try_emplace(key);
  GalleryColumn& column = at->second;
  if (is_new) {
    column.key = key;
    column.type = type;
    const auto* const known = std::find_if(k_known.begin(), k_known.end(),
                                           [&](const Known& row) { return row.key == key; });
    // Of draws and of further classes the name behind the point.
    column.label = known == k_known.end() ? key.substr(key.find('.') + 1) : known->label;
    column.unit = known == k_known.end() ? "" : known->unit;
  }
  if (column.type == GalleryColumn::Type::list)
    column.texts.resize(images_ + 1);
  else
    column.numbers.resize(images_ + 1, k_unknown);
  return column;
}

void GalleryColumns::number(const std::string& key, std::optional<double> value) {
  if (!value) return;
  GalleryColumn& to = column(key, GalleryColumn::Type::number);
  // A draw that is a number here and a text there is a list of texts.
  if (to.type == GalleryColumn::Type::list)
    to.texts[images_] = short_json_number(*value);
  else
    to.numbers[images_] = *value;
}

void GalleryColumns::list(const std::string& key, const std::string& value) {
  GalleryColumn& to = column(key, GalleryColumn::Type::list);
  if (to.type == GalleryColumn::Type::number) {
    to.type = GalleryColumn::Type::list;
    for (const double number : to.numbers)
      to.texts.push_back(std::isfinite(number) ? short_json_number(number) : "");
    to.numbers.clear();
  }
  to.texts[images_] = value;
}

void GalleryColumns::add_camera(const json& line) {
  const std::optional<Matrix> pose = matrix_of(line, "camera_to_world");
  if (!pose) return;
  const Matrix& m = *pose;
  // Seen from the camera backwards: where it stands as its target sees it.
  const std::array<double, 3> back{-m[0][2], -m[1][2], -m[2][2]};
  number("azimuth", tenths(degrees(std::atan2(back[1], back[0]))));
  number("elevation", tenths(degrees(std::asin(std::clamp(back[2], -1.0, 1.0)))));
  std::array<double, 3> from{m[0][3], m[1][3], m[2][3]};
  const std::array<double, 3> middle = model_middle(line);
  for (std::size_t i = 0; i < 3; ++i)
    from[i] -= middle[i];
  number("distance", std::sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2]));
}

void GalleryColumns::add_draws(const json& line) {
  const auto draws = line.find("draws");
  if (draws == line.end() || !draws->is_object()) return;
  for (const auto& [name, value] : draws->items()) {
    const std::string key = std::string(k_draw) + name;
    if (value.is_number())
      number(key, value.get<double>());
    else if (value.is_string())
      list(key, value.get<std::string>());
    else if (value.is_boolean())
      list(key, value.get<bool>() ? "true" : "false");
    else if (value.is_array())
      for (std::size_t i = 0; i < value.size(); ++i)
        if (value[i].is_number()) number(fmt::format("{}.{}", key, i), value[i].get<double>());
  }
}

void GalleryColumns::add(const json& line, const ImageExtras& extras) {
  list("class", text_of(line, "class_path"));
  for (const char* key : {"split", "model", "material", "environment", "view"})
    list(key, text_of(line, key));
  if (const auto others = line.find("classes"); others != line.end() && others->is_object())
    for (const auto& [name, path] : others->items())
      if (path.is_string()) list(std::string(k_classes) + name, path.get<std::string>());
  const double width = number_of(line, "width").value_or(0),
               height = number_of(line, "height").value_or(0);
  const double pixels = width * height;
  number("error", number_of(line, "relative_error"));
  const auto samples = number_of(line, "film", "samples");
  if (samples && pixels > 0)
    number("samples", *samples / pixels);
  else
    number("samples", number_of(line, "spp"));
  number("rejected", number_of(line, "rejected_samples"));
  if (const auto area = number_of(line, "pixel_counts", "model"); area && pixels > 0)
    number("area", *area / pixels);
  number("visible", number_of(line, "visible_fraction"));
  number("truncation", number_of(line, "truncation"));
  number("occlusion", number_of(line, "occlusion"));
  number("border", number_of(line, "pixel_counts", "frame"));
  if (const auto objects = line.find("objects"); objects != line.end() && objects->is_array())
    number("objects", static_cast<double>(objects->size()));
  if (extras.box && pixels > 0) {
    const auto& box = *extras.box;
    number("box_x", (box[0] + box[2] / 2.0) / width);
    number("box_y", (box[1] + box[3] / 2.0) / height);
  }
  number("brightness", extras.brightness);
  number("contrast", extras.contrast);
  add_camera(line);
  const auto rows = line.find("intrinsics");
  if (rows != line.end() && rows->is_array() && rows->size() == 3 && (*rows)[0].is_array() &&
      !(*rows)[0].empty() && (*rows)[0][0].is_number() && (*rows)[0][0] > 0)
    number(
        "fov",
        tenths(2 * degrees(std::atan(std::max(width, height) / 2 / (*rows)[0][0].get<double>()))));
  number("width", width);
  number("height", height);
  add_draws(line);
  ++images_;
}

std::vector<GalleryColumn> GalleryColumns::take() && {
  std::vector<GalleryColumn> columns;
  const auto keep = [&](GalleryColumn& column) {
    column.texts.resize(column.type == GalleryColumn::Type::list ? images_ : 0);
    column.numbers.resize(column.type == GalleryColumn::Type::number ? images_ : 0, k_unknown);
    column.values = column.texts;
    std::sort(column.values.begin(), column.values.end(), as_people_count);
    column.values.erase(std::unique(column.values.begin(), column.values.end()),
                        column.values.end());
    const bool says = column.type == GalleryColumn::Type::number || column.values.size() > 1 ||
                      (column.values.size() == 1 && !column.values[0].empty());
    if (says) columns.push_back(std::move(column));
  };
  const auto keep_all = [&](std::string_view prefix) {
    for (auto& [key, column] : columns_)
      if (key.starts_with(prefix)) keep(column);
  };
  for (const Known& known : k_known) {
    const auto at = columns_.find(std::string(known.key));
    if (at != columns_.end()) keep(at->second);
    if (known.key == "class") keep_all(k_classes);
  }
  keep_all(k_draw);
  return columns;
}

}  // namespace ds

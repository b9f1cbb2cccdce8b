// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/columns.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

using nlohmann::json;

const GalleryColumn* find(const std::vector<GalleryColumn>& columns, const std::string& key) {
  for (const GalleryColumn& column : columns)
    if (column.key == key) return &column;
  return nullptr;
}

/// One that must be there.
const GalleryColumn& at(const std::vector<GalleryColumn>& columns, const std::string& key) {
  static const GalleryColumn none;
  const GalleryColumn* const column = find(columns, key);
  EXPECT_NE(column, nullptr) << key;
  return column == nullptr ? none : *column;
}

/// A camera on the x axis that looks at the origin: right is +y, down is -z, forward is -x.
json line_at(double x) {
  return {{"id", "m/0"},
          {"class_path", "a/b"},
          {"model", "m"},
          {"width", 200},
          {"height", 100},
          {"relative_error", nullptr},
          {"pixel_counts", {{"model", 5000}}},
          {"film", {{"samples", 80000}}},
          {"intrinsics", {{100, 0, 100}, {0, 100, 50}, {0, 0, 1}}},
          {"camera_to_world", {{0, 0, -1, x}, {1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}}};
}

TEST(GalleryColumns, ViewsAreInTheOrderOfTheirNumbers) {
  GalleryColumns collected;
  for (const char* view : {"0", "1", "10", "13-2", "13-10", "2", "a10", "a9", "03", "3", ""}) {
    json line = line_at(2);
    line["view"] = view;
    collected.add(line, {});
  }
  EXPECT_EQ(
      at(std::move(collected).take(), "view").values,
      (std::vector<std::string>{"", "0", "1", "2", "03", "3", "10", "13-2", "13-10", "a9", "a10"}));
  // A strict order of different texts: none is before itself, and of two one is.
  for (const std::string a : {"", "1", "01", "1a", "a", "a1", "10"})
    for (const std::string b : {"", "1", "01", "1a", "a", "a1", "10"})
      EXPECT_EQ(as_people_count(a, b) + as_people_count(b, a), a == b ? 0 : 1) << a << " " << b;
}

TEST(GalleryColumns, AreWhatTheLineSays) {
  GalleryColumns collected;
  collected.add(line_at(2), {.brightness = 0.5, .contrast = {}, .box = {{50, 0, 100, 50}}});
  json second = line_at(3);
  second["split"] = "test";
  second["box_m"] = {{0.5, -1, -1}, {1.5, 1, 1}};
  second["classes"]["coarse"] = "solid";
  second["relative_error"] = 0.25;
  collected.add(second, {});
  const std::vector<GalleryColumn> columns = std::move(collected).take();
  const auto number = [&](const char* key, std::size_t image) {
    return at(columns, key).numbers.at(image);
  };
  EXPECT_DOUBLE_EQ(number("azimuth", 0), 0);
  EXPECT_DOUBLE_EQ(number("elevation", 0), 0);
  EXPECT_DOUBLE_EQ(number("distance", 0), 2);
  EXPECT_DOUBLE_EQ(number("distance", 1), 2) << "from the model, where that is known";
  EXPECT_DOUBLE_EQ(number("fov", 0), 90);
  EXPECT_DOUBLE_EQ(number("area", 0), 0.25);
  EXPECT_DOUBLE_EQ(number("samples", 0), 4);
  EXPECT_DOUBLE_EQ(number("box_x", 0), 0.5);
  EXPECT_DOUBLE_EQ(number("box_y", 0), 0.25);
  EXPECT_TRUE(std::isnan(number("box_x", 1)));
  EXPECT_TRUE(std::isnan(number("error", 0)));
  EXPECT_DOUBLE_EQ(number("error", 1), 0.25);
  EXPECT_EQ(find(columns, "contrast"), nullptr) << "nobody knows it";
  EXPECT_EQ(find(columns, "material"), nullptr) << "no image has one";
  EXPECT_EQ(at(columns, "split").values, (std::vector<std::string>{"", "test"}));
  EXPECT_EQ(at(columns, "classes.coarse").label, "coarse");
  EXPECT_EQ(at(columns, "classes.coarse").texts, (std::vector<std::string>{"", "solid"}));
  EXPECT_EQ(at(columns, "class").texts, (std::vector<std::string>{"a/b", "a/b"}));
}

TEST(GalleryColumns, DrawsAreColumns) {
  GalleryColumns collected;
  json line = line_at(1);
  line["draws"] = {{"yaw", 12.5}, {"sky", "clear"}, {"shift", {1, 2}}, {"odd", 3}};
  collected.add(line, {});
  line["draws"] = {{"yaw", 13.5}, {"odd", "none"}};
  collected.add(line, {});
  const std::vector<GalleryColumn> columns = std::move(collected).take();
  EXPECT_EQ(at(columns, "draw.yaw").numbers, (std::vector<double>{12.5, 13.5}));
  EXPECT_EQ(at(columns, "draw.yaw").label, "yaw");
  EXPECT_EQ(at(columns, "draw.sky").texts, (std::vector<std::string>{"clear", ""}));
  EXPECT_DOUBLE_EQ(at(columns, "draw.shift.1").numbers.at(0), 2);
  EXPECT_EQ(at(columns, "draw.odd").texts, (std::vector<std::string>{"3", "none"}));
}

TEST(GalleryColumns, NumbersAreShort) {
  EXPECT_EQ(short_json_number(0.1234567), "0.123457");
  EXPECT_EQ(short_json_number(-0.0), "0");
  EXPECT_EQ(short_json_number(std::nan("")), "null");
}

}  // namespace
}  // namespace ds

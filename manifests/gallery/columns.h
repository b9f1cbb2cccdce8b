// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What the gallery knows of an image beside its line of the manifest.
struct ImageExtras {
  std::optional<double> brightness, contrast;
  std::optional<std::array<int, 4>> box{};  ///< x, y, width, height of what is seen, in pixels
};

/// What the page can filter, sort and plot by: a column of the grid.
struct GalleryColumn {
  enum class Type {
    list,    ///< few texts: indices into `values`
    number,  ///< rounded to six digits; null where it is not known
  };
  std::string key, label, unit;
  Type type = Type::number;
  std::vector<std::string> values{};  ///< of a list, ordered
  std::vector<double> numbers{};      ///< one an image; NaN: not known
  std::vector<std::string> texts{};   ///< of a list, one an image
};

/// Collects columns from the manifest's lines, in order.
class GalleryColumns {
 public:
  /// `line`: an image of images.jsonl. Fields that a newer dsbuild adds are taken where they are
  /// known here: "classes" (an object of texts), "truncation", "occlusion", "visible_fraction", "draws"
  /// (an object of numbers and texts), "box_m".
  void add(const nlohmann::json& line, const ImageExtras& extras);
  /// Those that hold anything, in the order they are shown.
  std::vector<GalleryColumn> take() &&;

 private:
  GalleryColumn& column(const std::string& key, GalleryColumn::Type type);
  void number(const std::string& key, std::optional<double> value);
  void list(const std::string& key, const std::string& value);
  void add_camera(const nlohmann::json& line);
  void add_draws(const nlohmann::json& line);

  std::map<std::string, GalleryColumn> columns_;
  std::size_t images_ = 0;
};

/// Order of a list's values: digits that stand together are a number ("2" before "10", "v9" before "v10"),
/// the rest is by bytes.
bool as_people_count(const std::string& a, const std::string& b);

/// "0.0312", "12", "null": six digits at most.
std::string short_json_number(double value);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a recipe drew of one key for an image: a number or, of a point or a colour, several.
struct DrawRecord {
  std::vector<double> values;
  bool whole = false;  ///< of a key of whole numbers

  bool operator==(const DrawRecord&) const = default;
};
/// By key: "camera.fov_deg".
using DrawRecords = std::map<std::string, DrawRecord>;

/// What was drawn of one key for all images that a manifest lists.
struct DrawSummary {
  std::string distribution;  ///< as TOML: "{uniform = [35.0, 60.0]}"
  std::uint64_t count = 0;
  std::vector<double> least, most, mean;  ///< empty where nothing was drawn

  bool operator==(const DrawSummary&) const = default;
};
using DrawSummaries = std::map<std::string, DrawSummary>;

/// {"camera.fov_deg": 47.31, "camera.target": [0.01, ...]}.
nlohmann::json to_json_value(const DrawRecords& draws);
/// Throws Error(asset), "draws: ...", for what is no such object.
DrawRecords draws_from(const nlohmann::json& value);

/// {"camera.fov_deg": {"distribution", "count", "min", "max", "mean"}}, the last three null where
/// nothing was drawn.
nlohmann::json to_json_value(const DrawSummaries& draws);
/// Throws likewise.
DrawSummaries draw_summaries_from(const nlohmann::json& value);

}  // namespace ds

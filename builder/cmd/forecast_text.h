// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/forecast/forecast.h"

#include <nlohmann/json.hpp>

#include <string>

namespace ds {

/// "about 2:31:10 (2:10:00 to 2:52:20)".
std::string time_text(const Interval& seconds);
/// "1.2 GB (1.1 to 1.3)", in powers of 1000.
std::string size_text(const Interval& bytes);
/// A table, one pair a line.
std::string pairs_text(const Forecast& forecast);

/// {"value": ..., "low": ..., "high": ...}.
nlohmann::json interval_json(const Interval& interval);
nlohmann::json to_json(const Forecast& forecast);

}  // namespace ds

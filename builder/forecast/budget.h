// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/forecast/forecast.h"

#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What a time buys.
struct Bought {
  Interval error;       ///< low and high are what the ends of the time's interval buy
  bool capped = false;  ///< the time would do for a smaller error, engine.max_spp would not
};

/// The least error that every picture can have within `seconds` and with `most_spp` samples a
/// pixel (engine.max_spp, at least 16). Nothing where the least samples a pixel take longer, or
/// where no image's error is known.
std::optional<Bought> error_for(const std::vector<ProbedWork>& work, double seconds,
                                double most_spp);

/// Samples a pixel that the picture in need of most takes to this error: the least engine.max_spp
/// with which none is capped. 0 where none is to be traced.
double most_spp_for(const std::vector<ProbedWork>& work, double error);

/// "8h", "90m", "45s", "1h30m", "2.5h" in seconds. Nothing for any other text or 0.
std::optional<double> parse_duration(const std::string& text);

}  // namespace ds

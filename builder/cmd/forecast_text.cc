// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/forecast_text.h"

#include "builder/cmd/plan_text.h"
#include "builder/cmd/progress.h"
#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

std::string samples_text(double spp) {
  if (spp == 0) return "-";
  return spp < 100 ? fmt::format("{:.1f}", spp) : fmt::format("{:.0f}", spp);
}

std::string error_text(const PairForecast& pair) {
  if (pair.spp == 0) return "-";
  return pair.error > 0 ? fmt::format("{:.2g} %", 100 * pair.error) : "?";
}

nlohmann::json to_json(const PairForecast& pair, bool by_error) {
  nlohmann::json object{{"environment", pair.environment},
                        {"material", pair.material},
                        {"images", pair.images},
                        {"made", pair.made},
                        {"spp", pair.spp},
                        {"traced_spp", pair.traced_spp},
                        {"engine_error", nullptr},
                        {"relative_error", nullptr},
                        {"capped", pair.capped},
                        {"seconds_an_image", pair.seconds_an_image}};
  if (pair.spp > 0) object[by_error ? "engine_error" : "relative_error"] = pair.error;
  return object;
}

/// What stands behind a line of the table.
std::string capped_text(double share) {
  if (share == 0) return "";
  return share > 1 - 1e-9 ? "  capped" : fmt::format("  {:.0f} % capped", 100 * share);
}

}  // namespace

std::string time_text(const Interval& seconds) {
  return fmt::format("about {} ({} to {})", format_duration(seconds.value),
                     format_duration(seconds.low), format_duration(seconds.high));
}

std::string size_text(const Interval& bytes) {
  const char* unit = "kB";
  double size = 1e3;
  for (const char* larger : {"MB", "GB", "TB"}) {
    if (bytes.value < 1000 * size) break;
    unit = larger;
    size *= 1000;
  }
  return fmt::format("{:.3g} {} ({:.3g} to {:.3g})", bytes.value / size, unit, bytes.low / size,
                     bytes.high / size);
}

std::string pairs_text(const Forecast& forecast) {
  std::size_t environment = 11;
  std::size_t material = 8;
  for (const PairForecast& pair : forecast.pairs) {
    environment = std::max(environment, pair.environment.size());
    material = std::max(material, pair.material.size());
  }
  // Of the developed picture with 97.5 % confidence, or the linear one's as the manifest has it.
  const char* error = forecast.by_error ? "engine.error" : "relative_error";
  std::string text =
      fmt::format("{:{}}  {:{}}  {:>9}  {:>8}  {:>8}  {:>14}  {:>10}\n", "environment", environment,
                  "material", material, "to make", "samples", "to trace", error, "s an image");
  for (const PairForecast& pair : forecast.pairs)
    text += fmt::format("{:{}}  {:{}}  {:>9}  {:>8}  {:>8}  {:>14}  {:>10.3g}{}\n",
                        pair.environment, environment, pair.material, material,
                        fmt::format("{}/{}", pair.made, pair.images), samples_text(pair.spp),
                        samples_text(pair.traced_spp), error_text(pair), pair.seconds_an_image,
                        capped_text(pair.capped));
  return text;
}

nlohmann::json interval_json(const Interval& interval) {
  return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

nlohmann::json to_json(const Forecast& forecast) {
  nlohmann::json pairs = nlohmann::json::array();
  for (const PairForecast& pair : forecast.pairs)
    pairs.push_back(to_json(pair, forecast.by_error));
  return {{"seconds", interval_json(forecast.seconds)},
          {"bytes", interval_json(forecast.bytes)},
          {"bytes_by_kind", forecast.bytes_by_kind},
          {"pairs", pairs}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/page/csv.h"

#include <fmt/format.h>

#include <cmath>

namespace ds {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string number(std::optional<double> value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : "";
}

/// One pair's lines.
class Lines {
 public:
  Lines(std::string& out, const PairAccuracy& pair) : out_(out), pair_(pair) {}

  struct At {
    std::optional<double> spp{}, seconds{};
  };
  void add(const std::string& section, const std::string& name, const std::string& metric, At at,
           double value, std::optional<double> low = {}, std::optional<double> high = {}) {
    out_ +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", section, field(pair_.environment),
                    field(pair_.material), field(pair_.image), field(name), metric, number(at.spp),
                    number(at.seconds), number(value), number(low), number(high));
  }
  void add(const std::string& section, const std::string& name, const std::string& metric, At at,
           const Interval& interval) {
    add(section, name, metric, at, interval.value, interval.low, interval.high);
  }

 private:
  std::string& out_;
  const PairAccuracy& pair_;
};

void add_ladder(Lines& lines, const PairAccuracy& pair) {
  for (const Rung& rung : pair.ladder) {
    const Lines::At at{double(rung.spp), rung.seconds.value};
    lines.add("ladder", "", "seconds", at, rung.seconds);
    for (const auto& [metric, interval] : rung.metrics)
      lines.add("ladder", "", metric_name(metric), at, interval);
    if (rung.estimate) lines.add("ladder", "", "estimate", at, *rung.estimate);
  }
  lines.add("reference", "", "error", {}, pair.reference_error);
  for (const auto& [metric, value] : pair.floor)
    lines.add("reference", "", metric_name(metric), {}, value);
  lines.add("reference", "", "setup_seconds", {}, pair.setup_seconds);
}

void add_fit(Lines& lines, const PairAccuracy& pair) {
  if (!pair.law) return;
  lines.add("fit", "slope", "error", {}, pair.law->line.slope_interval());
  lines.add("fit", "error at 1 spp", "error", {}, pair.law->error(1));
  lines.add("fit", "seconds of a sample a pixel", "seconds", {}, pair.seconds.slope_interval());
  for (const Target& target : pair.targets) {
    const std::string name = fmt::format("{}{}", target.error, target.extrapolated ? " *" : "");
    lines.add("target", name, "spp", {}, target.spp);
    lines.add("target", name, "seconds", {}, target.seconds);
  }
}

void add_geometry(Lines& lines, const PairAccuracy& pair) {
  for (const GeometryRung& rung : pair.geometry) {
    const Lines::At at{double(rung.rays), rung.seconds};
    lines.add("geometry", "", "mask_rms", at, rung.errors.mask_rms);
    lines.add("geometry", "", "mask_wrong", at, rung.errors.mask_wrong);
    lines.add("geometry", "", "depth_rms", at, rung.errors.depth_rms);
  }
}

void add_choices(Lines& lines, const PairAccuracy& pair) {
  if (pair.plain_sums_spp > 0)
    lines.add("choice", "sums plain", "bias", {double(pair.plain_sums_spp), {}}, pair.plain_sums);
  for (const ChoiceCost& cost : pair.choices) {
    const std::string name = cost.choice.group + " " + cost.choice.name;
    lines.add("choice", name, "time_ratio", {}, cost.time);
    if (cost.noise) lines.add("choice", name, "noise_ratio", {}, *cost.noise);
    if (cost.bias) lines.add("choice", name, "bias", {}, *cost.bias);
  }
}

}  // namespace

std::string accuracy_csv(const Accuracy& accuracy) {
  std::string out = "section,environment,material,image,name,metric,spp,seconds,value,low,high\n";
  for (const PairAccuracy& pair : accuracy.pairs) {
    Lines lines(out, pair);
    add_ladder(lines, pair);
    add_fit(lines, pair);
    add_geometry(lines, pair);
    add_choices(lines, pair);
  }
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k]))
                                  : 0U;
    };
    const unsigned word = at(0) << 16 | at(1) << 8 | at(2);
    out += digits[word >> 18];
    out += digits[word >> 12 & 63];
    out += i + 1 < bytes.size() ? digits[word >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? digits[word & 63] : '=';
  }
  return out;
}

std::string csv_link(const std::string& csv) {
  return "data:text/csv;charset=utf-8;base64," + base64(csv);
}

}  // namespace ds

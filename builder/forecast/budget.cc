// SPDX-License-Identifier: Apache-2.0
#include "builder/forecast/budget.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace ds {
namespace {

/// Every picture has a smaller error with its least samples.
constexpr double k_any_error = 1e6;
/// The range of engine.error, and beyond it what the first step of a noisy picture may have.
constexpr double k_least_error = 1e-6, k_most_error = 100;

template <typename Of>
double greatest_of_traced(const std::vector<ProbedWork>& work, const Of& of) {
  double greatest = 0;
  for (const ProbedWork& pair : work) {
    if (pair.work.trace == 0) continue;
    for (const std::optional<ErrorLaw>& law : error_laws(pair.probes, true))
      if (law) greatest = std::max(greatest, of(*law));
  }
  return greatest;
}

}  // namespace

std::optional<Bought> error_for(const std::vector<ProbedWork>& work, double seconds,
                                double most_spp) {
  const auto knows_error = [](const ProbedWork& pair) {
    for (const auto& law : error_laws(pair.probes, true))
      if (!law) return false;
    return true;
  };
  if (work.empty() || !std::all_of(work.begin(), work.end(), knows_error)) return std::nullopt;
  const auto seconds_for = [&](double error) {
    return forecast(work, {error, 1, most_spp}).seconds;
  };
  if (seconds_for(k_any_error).value > seconds) return std::nullopt;
  const double floor =
      std::max(k_least_error,
               greatest_of_traced(work, [&](const ErrorLaw& law) { return law.error(most_spp); }));
  // Time falls as the error grows: halve the range of its logarithm until it is narrow.
  const auto least_error = [&](double Interval::*bound) {
    if (seconds_for(floor).*bound <= seconds) return floor;
    double low = std::log(floor);
    double high = std::log(std::max(k_most_error, floor));
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      const bool fits = seconds_for(std::exp(middle)).*bound <= seconds;
      (fits ? high : low) = middle;
    }
    return std::exp(high);
  };
  const Interval error{least_error(&Interval::value), least_error(&Interval::low),
                       least_error(&Interval::high)};
  return Bought{error, error.value == floor && floor > k_least_error};
}

double most_spp_for(const std::vector<ProbedWork>& work, double error) {
  return greatest_of_traced(work, [&](const ErrorLaw& law) { return law.spp_for(error); });
}

std::optional<double> parse_duration(const std::string& text) {
  double seconds = 0;
  double last_unit = 1e9;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double value = 0;
    const auto [letter, error] = std::from_chars(at, end, value, std::chars_format::fixed);
    if (error != std::errc() || letter == end || value < 0) return std::nullopt;
    const double unit = *letter == 'd'   ? 86400
                        : *letter == 'h' ? 3600
                        : *letter == 'm' ? 60
                        : *letter == 's' ? 1
                                         : 0;
    // Days before hours before minutes before seconds, each once.
    if (unit == 0 || unit >= last_unit) return std::nullopt;
    last_unit = unit;
    seconds += unit * value;
    at = letter + 1;
  }
  if (!(seconds > 0) || !std::isfinite(seconds)) return std::nullopt;
  return seconds;
}

}  // namespace ds

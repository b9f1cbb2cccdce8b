// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace ds::audit {

/// The worst of one stage of the tracer: of the differences themselves, and of what they are in
/// half-ulps (2^-24) times the condition of their question.
class Stage {
 public:
  explicit Stage(std::string name) : name_(std::move(name)) {}

  /// A difference that is not a number counts as infinite.
  void add(double difference, double condition, const std::string& where) {
    ++count_;
    if (!(difference <= worst_)) {
      worst_ = std::isnan(difference) ? INFINITY : difference;
      worst_where_ = where;
    }
    const double half_ulps = difference / (condition * 0x1p-24);
    if (!(half_ulps <= worst_half_ulps_)) {
      worst_half_ulps_ = std::isnan(half_ulps) ? INFINITY : half_ulps;
      half_ulps_where_ = where;
    }
  }

  /// Prints the stage's line and holds it to `bound` half-ulps times the condition.
  void expect_within(double bound) const {
    std::printf("%-34s %8zu  %9.2e  %-34s %8.2f of %-6g %s\n", name_.c_str(), count_, worst_,
                worst_where_.c_str(), worst_half_ulps_, bound, half_ulps_where_.c_str());
    EXPECT_GT(count_, 100u) << name_;
    EXPECT_LE(worst_half_ulps_, bound) << name_ << ": " << half_ulps_where_;
  }

 private:
  std::string name_, worst_where_, half_ulps_where_;
  std::size_t count_ = 0;
  double worst_ = 0, worst_half_ulps_ = 0;
};

}  // namespace ds::audit

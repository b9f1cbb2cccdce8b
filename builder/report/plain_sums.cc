// SPDX-License-Identifier: Apache-2.0
#include "builder/report/plain_sums.h"

#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"

#include <cmath>

namespace ds {

void PlainSums::add(const FilmSums& film) {
  const std::size_t values = 3 * film.pixels();
  if (totals_.empty()) {
    totals_.resize(values);
    plain_.resize(values);
  }
  DS_ASSERT(totals_.size() == values);
  const float* sums = film.plane(kernels::k_film_sum).data();
  const float* rest = film.plane(kernels::k_film_compensation).data();
  for (std::size_t i = 0; i < values; ++i) {
    const double total = double{sums[i]} + double{rest[i]};
    plain_[i] += static_cast<float>(total - totals_[i]);
    totals_[i] = total;
  }
}

double PlainSums::relative_error() const {
  const std::size_t pixels = totals_.size() / 3;
  double squares = 0;
  double luminance = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto weighed = [&](const auto& values) {
      return 0.2126 * double{values[i]} + 0.7152 * double{values[pixels + i]} +
             0.0722 * double{values[2 * pixels + i]};
    };
    const double whole = weighed(totals_);
    const double off = weighed(plain_) - whole;
    squares += off * off;
    luminance += whole;
  }
  if (!(luminance > 0)) return 0;
  return std::sqrt(squares / static_cast<double>(pixels)) /
         (luminance / static_cast<double>(pixels));
}

}  // namespace ds

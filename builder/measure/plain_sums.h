// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/film.h"

#include <vector>

namespace ds {

/// What a film's pixels would be, were their samples added up in plain floats: the samples are
/// taken out of a film that gets one after the other.
class PlainSums {
 public:
  /// The film with one more sample of every pixel than the last time; at first with one.
  void add(const FilmSums& film);
  /// RMS difference of the plain sums' luminance (Rec.709) from the film's, over its mean
  /// luminance; 0 for a black film.
  double relative_error() const;

 private:
  std::size_t pixels_ = 0;
  std::vector<double> totals_;  ///< planes of r, g, b: the film's own sums
  std::vector<float> plain_;
};

}  // namespace ds

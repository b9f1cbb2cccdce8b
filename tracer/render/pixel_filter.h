// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/film.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ds {

/// The pixel filter: a separable Blackman-Harris window around the pixel's centre. Samples lie
/// evenly in their pixels and are added to the quarter of the pixel that they are in; developing
/// weighs the quarters around with what the filter has over each. So a sample serves every pixel
/// whose filter it is under, as where samples are splatted, yet each is added in one place and in
/// order, and tiles may have different numbers of samples. Measured against a sample that serves
/// one pixel only (Ernst, Stamminger and Greiner 2006): the variance of white noise falls by the
/// square of 1 / (2 * sum of weights()^2), 2.5 at the width of 3.
class PixelFilter {
 public:
  /// `width`: of the whole window in pixels, 0 .. 16. Up to 1 it is a box of one pixel, since half
  /// pixels are the finest it can show.
  explicit PixelFilter(float width);

  /// How many pixels to each side it asks.
  std::size_t reach() const { return reach_; }
  /// Of half pixels along one axis from the first of pixel -reach to the last of pixel reach; their
  /// sum is 1.
  std::span<const double> weights() const { return weights_; }
  /// What part of a pixel's variance comes from each of the pixels along one axis, from -reach to
  /// reach, where all have the same; their sum is 1.
  std::span<const double> shares() const { return shares_; }
  /// Sum over all pixels of the squared correlation between their noise and one pixel's, where all
  /// quarters have the same: 1 where none is shared.
  double correlation() const;

 private:
  std::size_t reach_;
  std::vector<double> weights_, shares_;
};

/// The pixels of a rectangle row by row, through the filter. A quarter without samples, and what is
/// outside the picture, has no weight; the weights left are brought to a sum of 1. Where none is
/// left, as in a scene without light, which is not traced, the pixel is black.
std::vector<PixelEstimate> filtered(const FilmSums& film, const PixelFilter& filter,
                                    const PixelRect& rect);

}  // namespace ds

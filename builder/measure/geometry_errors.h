// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <vector>

namespace ds {

/// What a pixel's mask and depth would be with many rays a pixel. A dataset's mask and depth have
/// one, through the pixel's centre: exact there, and blind to the rest of the pixel.
struct Coverage {
  int width = 0, height = 0;
  std::vector<float> model;  ///< share of the pixel that shows the model, 0 .. 1
  std::vector<float> depth;  ///< mean planar z in metres over the rays that hit; 0 where none does
  std::vector<float> hits;   ///< share of the rays that hit anything
};

/// Averages squares of `factor` x `factor` rays of a geometry traced at `factor` times the size of
/// the picture, which must be a multiple of it. factor = 1 gives the geometry itself.
Coverage coverage_of(const Geometry& geometry, int factor);

struct GeometryErrors {
  double mask_rms = 0;    ///< RMS difference of the share that shows the model
  double mask_wrong = 0;  ///< share of the pixels whose mask, cut at one half, differs
  /// RMS of (depth - reference) / reference over the pixels that are hit in both, whole in the
  /// reference; 0 where there is none.
  double depth_rms = 0;
};
/// Both of one size.
GeometryErrors geometry_errors(const Coverage& found, const Coverage& reference);

}  // namespace ds

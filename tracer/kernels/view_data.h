// SPDX-License-Identifier: Apache-2.0
// The camera and engine settings that host and device share. Only 4-byte scalars.
#pragma once

#include "tracer/kernels/language.h"

/// Constants of a picture: the camera and the engine settings.
typedef struct {
  float start[3];        ///< world, metres: where rays through the picture's middle start; see
                         ///< ray_start_m of tracer/render/view.h
  float start_right[3];  ///< how far from there those through the middle of its right edge do, ...
  float start_up[3];     ///< ... and of its upper edge
  float start_depth;     ///< metres before the camera, along forward
  float right[3];        ///< world vector of half the image plane's width at distance 1
  float up[3];           ///< world vector of half the image plane's height at distance 1
  float forward[3];      ///< unit, world
  float lens_right[3];   ///< unit right times lens radius, metres
  float lens_up[3];
  /// The lens as rays' starts show it; at start_depth 0 the lens itself.
  float start_lens_right[3];
  float start_lens_up[3];
  float focus_distance;  ///< along forward, metres
  uint width, height;
  uint tiles_x;        ///< tiles in a row of tiles
  float sample_limit;  ///< greatest component a sample may have; what is brighter is scaled down
  uint seed_low, seed_high;
  uint depth_total, depth_diffuse, depth_glossy, depth_specular;
  uint roulette_depth;
  float roulette_cap;
} ViewData;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(ViewData) == 44 * 4, "no padding");
#endif

/// A work-item of planes makes a tile of as many pixels as it has lanes (1, 4, 8 or 16), as square as can
/// be.
DS_FN uint tile_width(uint lanes) {
  return lanes >= 8u ? 4u : lanes >= 4u ? 2u : 1u;
}
DS_FN uint tile_height(uint lanes) {
  return lanes / tile_width(lanes);
}

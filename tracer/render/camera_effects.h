// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/render.h"

#include <cstdint>
#include <string>

namespace ds {

/// What a camera does to a picture behind the film, which is traced without any of it. In this order.
struct CameraEffects {
  double exposure_ev = 0;  ///< factor 2^ev, on top of the tone map's, which is found without it
  double vignetting = 0;   ///< share of the light that the corners lose, in [0, 1]; grows as r^2
  double blur_px = 0;      ///< deviation of a Gaussian blur
  /// Deviation of the noise at white: sensor noise of variance noise^2 (v + 0.01), where v is the
  /// linear value of a channel under the tone map's scale: shot noise, and a tenth of its deviation at
  /// white read out in the dark.
  double noise = 0;
  int jpeg_quality = 0;  ///< 1 to 100: the picture is what a JPEG of this quality leaves; 0: exact
  std::uint64_t seed = 0;  ///< of the noise: the image's own

  /// Whether nothing is done.
  bool none() const {
    return exposure_ev == 0 && vignetting == 0 && blur_px == 0 && noise == 0 && jpeg_quality == 0;
  }
};

/// The film with exposure, vignetting, blur and noise, and no less than 0. `scale`: as
/// tone_map_scale finds it for the film. The same bits on every machine. Each number of the noise is
/// of (seed, x, y, channel) alone.
Film with_effects(const Film& film, double scale, const CameraEffects& effects);

struct DevelopedPicture {
  BytePicture picture;
  double scale = 1;           ///< the tone map's, found without effects
  std::uint64_t clipped = 0;  ///< clipped_pixels, with effects
};
/// develop(film) under these effects: with_effects, developed at the scale of the film without them;
/// then through a JPEG. The JPEG's pixels are those of this machine's libjpeg.
DevelopedPicture develop(const Film& film, const ToneMap& tone_map, const CameraEffects& effects);

/// Canonical text: a line for each effect that does something; "" where none does.
std::string canonical_effects(const CameraEffects& effects);

}  // namespace ds

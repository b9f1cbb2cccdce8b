// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/develop.h"
#include "tracer/render/render.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace ds {

/// Rises and falls between 0 and 255.
inline int wave(int v, int period) {
  const int m = v % period;
  return (m < period / 2 ? m : period - m) * 510 / period;
}

/// Two pictures of whole numbers, so that the oracles in Python have the same ones:
///   y, x = np.mgrid[0:40, 0:48]; reference as below; test as below.
inline BytePicture wavy_picture() {
  BytePicture picture{48, 40, 3, {}};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (const int value :
           {wave(3 * x + y, 96), wave(x + 4 * y + 20, 128), wave(5 * x + 2 * y, 160)})
        picture.pixels.push_back(static_cast<std::uint8_t>(value));
  return picture;
}

inline BytePicture spoilt_picture() {
  BytePicture picture = wavy_picture();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      std::uint8_t* p = &picture.pixels[static_cast<std::size_t>((y * picture.width + x) * 3)];
      p[0] = static_cast<std::uint8_t>(std::clamp(p[0] + (x * 7 + y * 13) % 31 - 15, 0, 255));
      if (y >= 10 && y < 20 && x >= 15 && x < 30) p[1] = static_cast<std::uint8_t>(255 - p[1]);
      if (y >= 30) p[2] = static_cast<std::uint8_t>(p[2] / 2);
      if (y == 5 && x == 5) p[0] = p[1] = p[2] = 255;
      if (y == 25 && x == 40) p[0] = p[1] = p[2] = 0;
    }
  return picture;
}

/// Radiance `mean` in every pixel plus noise of standard deviation `noise`, the same in the three
/// channels.
inline Film noisy_film(int side, float mean, float noise, unsigned seed) {
  Film film{side, side, {}, 0};
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  for (int i = 0; i < side * side; ++i) {
    const float value = mean + noise * normal(random);
    film.rgb.insert(film.rgb.end(), 3, value);
  }
  return film;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <cstddef>
#include <list>
#include <string>
#include <vector>

namespace ds {

/// Images as they were loaded for scenes before: thousands of models stand in one environment.
class LoadedImages {
 public:
  explicit LoadedImages(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// As load_images. What a file holds is known by Image::content; one without is read each time.
  void load(Scene& scene);

 private:
  struct Known {
    std::string use;  ///< all that the pixels depend on
    int width, height;
    std::vector<float> rgb;
  };
  void load(Image& image);

  std::size_t most_bytes_, bytes_ = 0;
  std::list<Known> known_;  ///< the last used first
};

}  // namespace ds

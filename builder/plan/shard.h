// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace ds {

/// One of `count` shares of a dataset's images, for as many builds. Every image is in one share,
/// by a hash of its id: adding or removing others leaves it there. Not by a hash of its model or
/// scene, though each were then loaded by one build only: shares of a few scenes are uneven (the
/// demo's 32 models by four: 16 to 44 images; its images by four: 27 to 35), and a dataset of one
/// scene would be one share. The default is the whole dataset.
struct Shard {
  std::uint32_t number = 1;  ///< in [1, count]
  std::uint32_t count = 1;

  bool holds(std::string_view image_id) const;
};

/// Reads "2/4", the second of four. Throws Error(usage).
Shard read_shard(std::string_view text);

}  // namespace ds

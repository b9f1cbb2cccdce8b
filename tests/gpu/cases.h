// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/pictures.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace ds::gpu {

/// What a case of a pack traces: a picture with its mask and depth, or, `timed`, a large picture or
/// these alone; or every plane that asks no light, or a picture with every plane of light.
enum class Traces { picture_and_geometry, picture, geometry, planes, light };

struct Case {
  pictures::Picture picture;
  Traces traces = Traces::picture_and_geometry;
  bool timed = false;
  /// What of the tracer's options differs from how GPUs are asked; nothing: not given.
  std::function<void(TracerOptions&)> change{};
};

/// A small picture of each material, texture and light of the tables, the pictures of all effects
/// (pictures.h), one by an error target, some that are asked for in other ways, and teapots in the
/// shipped environments, which are timed.
/// Throws Error(usage) for a light that has no scene here.
std::vector<Case> all_cases(const std::filesystem::path& assets);

}  // namespace ds::gpu

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"

#include <string>
#include <vector>

namespace ds {

/// A material whose textures read what some models have none of: their pictures show one colour
/// where a pattern was meant.
struct Lacking {
  std::string material;  ///< its file's name
  std::string reads;     ///< "uv" or "colours"
  std::vector<std::string> models;
};

/// Of the shard's images, by material and what it reads, models in the order of images.
std::vector<Lacking> find_lacking(const Plan& plan, Inputs& inputs);

/// One line, with the first few models by name.
std::string to_text(const Lacking& lacking);

}  // namespace ds

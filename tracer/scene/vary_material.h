// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace ds {

/// A constant in place of what a material file has: of the parts and textures that `pattern` names,
/// "NAME.PROPERTY" as the file has them, where a * of NAME stands for any letters.
struct PropertyValue {
  std::string_view pattern;
  Vec3d value;  ///< of a property of one number all three alike
};

/// What a material file has that a pattern names.
struct PropertyFit {
  int count = 0;        ///< properties
  bool colour = false;  ///< one is a colour
  bool flag = false;    ///< one is a flag or picks something, of which nothing lies between
};
PropertyFit fit_of(const Scene& material, std::string_view pattern);

/// The material with these values. A texture that stood in a value's place is not asked any more. Same bits
/// everywhere; later values win.
Scene with_values(Scene material, std::span<const PropertyValue> values);

}  // namespace ds

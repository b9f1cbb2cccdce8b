// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/keys.h"

#include <span>

namespace ds {

/// The keys of a recipe's section classes, in the order of the reference.
std::span<const KeySpec> class_keys();

}  // namespace ds

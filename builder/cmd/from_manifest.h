// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"

#include <string>

namespace ds {

/// What the dataset lacks of its recipe, for verbs that write what its manifest lists; "" where nothing,
/// or where nobody can tell. `written`: "exported is what the manifest lists".
std::string behind_recipe(const Arguments& arguments, const std::string& written);

}  // namespace ds

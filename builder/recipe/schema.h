// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace ds {

/// JSON Schema (draft 2020-12) of a recipe as TOML readers hand it on: sections of keys, none but those of
/// recipe_keys(). Keys may be written nested or dotted, which is one thing to a TOML reader. What one key
/// asks of another is in its description.
nlohmann::json recipe_schema();

}  // namespace ds

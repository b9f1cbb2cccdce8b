// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace ds {

/// JSON text that depends on the value only: keys sorted by bytes, integers as they are, other
/// numbers the shortest that read back exactly, always with a point or an exponent, -0 as 0.0. `indent` 0: one line without spaces; else
/// as many spaces a level and a final line break. Throws Error(asset) for a number that is not
/// finite and for text that is not UTF-8.
std::string canonical_json(const nlohmann::json& value, int indent = 0);

/// What is wrong with a JSON text, without the library's name for the kind of error.
std::string json_fault(const nlohmann::json::exception& error);

}  // namespace ds

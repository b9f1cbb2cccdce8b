// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace ds {

/// Whether a name fits a pattern in which * stands for any letters.
bool fits_pattern(std::string_view name, std::string_view pattern);

}  // namespace ds

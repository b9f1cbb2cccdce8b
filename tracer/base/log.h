// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace ds {

/// One line on standard error, prefixed "dsbuild: warning: ". Safe from any thread; a line is never
/// torn.
void warn(std::string_view message);

}  // namespace ds

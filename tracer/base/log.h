// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace ds {

/// One line on standard error, prefixed "dsbuild: warning: "; nothing where the same was said
/// before: what is wrong with a file is said once, however often it is read. Safe from any thread;
/// a line is never torn.
void warn(std::string_view message);

/// How often `warn` was called, said or not.
std::uint64_t warning_count();

}  // namespace ds

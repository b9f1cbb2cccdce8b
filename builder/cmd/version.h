// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ds {

/// "dsbuild 0.1.0 (commit 1234567890ab)", the processor's level ("x86-64-v3") and OpenCL's platforms
/// with their versions, a line each.
std::string version_text();

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace ds {

/// Kernel files behind definitions, their includes put in place; each file once. What they have
/// between `#ifdef DS_HOOK_...` and `#endif` is left out where the definitions lack that: it is in no
/// program, and no key, that does not ask for it.
std::string assemble(const std::string& definitions, std::span<const std::string> paths);

}  // namespace ds

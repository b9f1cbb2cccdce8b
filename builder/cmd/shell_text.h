// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// "bash", "zsh", "fish", "man".
std::vector<std::string_view> shell_texts();
/// A shell's completions, or the manual page (roff), from the table of verbs. `kind`: one of these.
std::string shell_text(std::string_view kind);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace ds {

/// The tokens of an OpenCL C source in one spelling: without comments, lines joined where a
/// backslash goes on, one space between two tokens that would else be read as one, directives on
/// lines of their own. Two sources have the same tokens exactly where they differ in layout and
/// comments alone: what render keys take of a program, so that a formatter makes no picture stale.
std::string program_tokens(std::string_view source);

}  // namespace ds

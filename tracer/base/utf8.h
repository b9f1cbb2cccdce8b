// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <string>
#include <string_view>

namespace ds {

/// Well-formed UTF-8: no overlong form, no surrogate, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// Finds the first line of a file of names that is no UTF-8, or that all of it is UTF-16: adds one
/// finding then, and returns false.
bool check_utf8(std::string_view text, const std::string& file, Diagnostics& diagnostics);

/// Text of any encoding as UTF-8, for people to read: UTF-16 where its byte order mark says so
/// (what is unpaired becomes U+FFFD), UTF-8 as it is, without its mark; anything else as
/// Windows-1252, which ISO 8859-1 text is too and which has a character for every byte.
std::string utf8_of(std::string_view bytes);

}  // namespace ds

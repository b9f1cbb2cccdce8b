// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace ds {

/// The columns that UTF-8 text takes on a terminal: none for combining and invisible characters,
/// two for wide ones (East Asian, emoji), one for everything else and for each byte that is no
/// UTF-8. Of one line: control characters count as nothing.
int columns_of(std::string_view text);

/// The longest beginning of the text that takes at most so many columns; no character is torn, and
/// what combines with the last one stays with it.
std::string cut_to_columns(std::string_view text, int columns);

/// The text with its middle replaced by "..." where it takes more columns than that.
std::string shorten_to_columns(std::string_view text, int columns);

}  // namespace ds

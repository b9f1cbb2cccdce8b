// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/properties.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A number in C's spelling, whatever the locale, within the range of a float; nothing for any
/// other text.
std::optional<double> parse_sdl_number(std::string_view text);

/// The words of all values: LuxCore reads "0.5 0.5 0.5" in quotes as three numbers too.
std::vector<std::string> words_of(const Property& property);
/// As they stand, with a blank between them.
std::string joined(const Property& property);

/// Takes a colour space prefix off the words and returns the exponent that makes the numbers
/// linear; nothing for one that is not supported.
std::optional<double> take_color_space(std::vector<std::string>& words);
/// A number of a colour space of this exponent.
double linear(double value, double gamma);

}  // namespace ds

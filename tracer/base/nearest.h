// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Slips of the finger between two words: letters put in, left out, replaced, or two neighbours
/// swapped (optimal string alignment). By bytes.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that a misspelt word was most likely meant to be: the same but for case, else the
/// one with the fewest slips (two at most, one in a word of up to four letters, none in one of two), else the only one
/// that the word begins. "" where none looks like it. Of equals, the first.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);
std::string_view nearest(std::string_view word, const std::vector<std::string>& candidates);

/// For the end of a message: ", did you mean matte?", or "" where no candidate looks like it.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// As did_you_mean; where nothing looks like it and there are few, all: "; there are a, b, c".
std::string known_words(std::string_view word, std::span<const std::string_view> candidates);

/// did_you_mean for a path that is not there, of the names in its folder; "" for one that is.
std::string similar_name(const std::filesystem::path& path);

}  // namespace ds

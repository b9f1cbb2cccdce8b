// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// No line of a help text is longer, where its words let it: a terminal's least usual width.
inline constexpr std::size_t k_help_width = 80;

/// The text in lines of at most k_help_width, broken at spaces and after what it breaks itself;
/// every line but the first is indented by `indent`, and the first is taken to begin at `column`.
/// Ends without a line break.
std::string wrap(std::string_view text, std::size_t indent = 0, std::size_t column = 0);

struct HelpRow {
  std::string name, help;
};
/// The title and a colon, then the names in one column and the wrapped helps in another; a name too
/// long for its column has its help below it. "" for no rows.
std::string help_rows(std::string_view title, const std::vector<HelpRow>& rows);

/// What `dsbuild help TOPIC` knows beside the verbs, a row each.
std::vector<HelpRow> topic_rows();

bool is_recipe_section(std::string_view name);
/// Where a verb or topic has the name of a recipe's section: how to ask for that. "" elsewhere.
std::string recipe_section_hint(std::string_view name);

}  // namespace ds

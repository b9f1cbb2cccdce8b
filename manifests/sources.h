// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// Where assets of a dataset come from.
struct SourceRecord {
  std::string url;   ///< the first in the text; "" (null in the file) where it has none
  std::string text;  ///< as it stands beside the assets
  std::vector<std::string> assets;  ///< "models/mug.ply", sorted, each once

  bool operator==(const SourceRecord&) const = default;
};

/// The first http or https address in a text, to the next white space, quote or angle bracket and
/// without the mark that ends its sentence; "" where there is none.
std::string first_url(std::string_view text);

/// Pairs of asset and text as records: each text once, sorted by their first asset.
std::vector<SourceRecord> group_sources(
    const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace ds

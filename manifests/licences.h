// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// One licence of a dataset's assets.
struct LicenceRecord {
  std::string spdx;  ///< "CC0-1.0"; "" (null in the file) where the text is none of the known ones
  std::string text;  ///< as it stands beside the assets
  std::vector<std::string> assets;  ///< "models/mug.ply", sorted, each once

  bool operator==(const LicenceRecord&) const = default;
};

/// The SPDX id of a licence's text: that of its "SPDX-License-Identifier:" line, or of the one
/// known licence whose title or first words it holds, whatever its case and line breaks. "" for
/// any other text, one that holds several, and those whose text does not tell which id it is (the
/// GPL's: "only" or "or later").
std::string spdx_id(std::string_view text);

/// Pairs of asset and text as records: each text once, sorted by their first asset.
std::vector<LicenceRecord> group_licences(
    const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace ds

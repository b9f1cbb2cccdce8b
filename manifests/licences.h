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

/// Whether a file of that name beside assets is their licence: LICENSE, LICENCE, COPYING or UNLICENSE, in any case,
/// with an ending of a text (.txt, .md, .rst) or without, and with a licence's name between, as LICENSE-MIT,
/// LICENSE.CC-BY-4.0 and COPYING.LESSER. A model is none: license-plate.off.
bool is_licence_name(std::string_view name);
/// Whether a folder of that name beside assets holds their licences, a file each: LICENSES or LICENCES, in any
/// case, as REUSE has it.
bool is_licence_folder_name(std::string_view name);
/// SOURCE or SOURCES, in any case, likewise with an ending of a text or without.
bool is_source_name(std::string_view name);

/// Pairs of asset and text as records: each text once, sorted by their first asset.
std::vector<LicenceRecord> group_licences(
    const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace ds

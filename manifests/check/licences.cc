// SPDX-License-Identifier: Apache-2.0
// Models, materials and environments without a licence, or with one that not every use may have, or that allows
// less than the dataset's own.
#include "manifests/check/check.h"
#include "manifests/shown_assets.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <optional>
#include <set>

namespace ds {
namespace {

/// What a licence asks of who uses the work.
struct Terms {
  bool attribution = false, no_commerce = false, no_changes = false, same_licence = false;
};

/// Of licences known by name; nothing of others, of which nobody can tell it here.
std::optional<Terms> terms_of(std::string id) {
  std::transform(id.begin(), id.end(), id.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (id.find(' ') != id.npos) return std::nullopt;  // "MIT OR ISC", or words
  const auto has = [&](const char* part) { return id.find(part) != id.npos; };
  const auto begins_with_one_of = [&](const auto& heads) {
    return std::any_of(heads.begin(), heads.end(),
                       [&](const char* head) { return id.starts_with(head); });
  };
  if (begins_with_one_of(std::array{"CC0-", "0BSD", "UNLICENSE", "PDDL-", "MIT-0", "CC-PDDC"}))
    return Terms{};
  if (id.starts_with("CC-BY")) return Terms{true, has("-NC"), has("-ND"), has("-SA")};
  if (begins_with_one_of(std::array{"GPL-", "AGPL-", "LGPL-", "ODBL-"}))
    return Terms{true, false, false, true};
  if (begins_with_one_of(std::array{"MIT", "APACHE-", "BSD-", "ISC", "ZLIB", "ODC-BY-"}))
    return Terms{.attribution = true};
  return std::nullopt;
}

/// "commercial use", ...: what a licence `of_dataset` lets be done that `of_asset` does not; "" for nothing.
std::string allowed_beyond(const Terms& of_asset, const Terms& of_dataset) {
  std::vector<std::string> beyond;
  if (of_asset.no_commerce && !of_dataset.no_commerce) beyond.emplace_back("commercial use");
  if (of_asset.no_changes && !of_dataset.no_changes) beyond.emplace_back("changes");
  // Where nothing may be changed nobody can ask for a licence of the change.
  if (of_asset.same_licence && !of_dataset.same_licence && !of_dataset.no_changes)
    beyond.emplace_back("another licence");
  if (of_asset.attribution && !of_dataset.attribution) beyond.emplace_back("use without a name");
  return fmt::format("{}", fmt::join(beyond, ", "));
}

/// Of the images that show an asset for which `is` holds.
template <typename Is>
std::vector<std::string> ids_showing(const CheckInput& input, const Is& is) {
  return ids_where(input.images, [&](const ImageRecord& image) {
    const std::vector<std::string> shown = shown_assets(image, input.dataset);
    return std::any_of(shown.begin(), shown.end(), is);
  });
}

void check_missing(const CheckInput& input, CheckReport& report,
                   const std::set<std::string>& assets) {
  AssetNames licensed;
  for (const LicenceRecord& licence : input.dataset.licences)
    licensed.add(licence.assets);
  std::set<std::string> without;
  for (const std::string& asset : assets)
    if (!licensed.has(asset)) without.insert(asset);
  // Where none has one it is of no image more than of another.
  report.add(CheckLevel::warning, "models and scenes have no licence beside them",
             {without.begin(), without.end()}, assets.size(), "a LICENSE file in their folders",
             licensed.empty() ? std::vector<std::string>()
                              : ids_showing(input, [&](const std::string& asset) {
                                  return without.contains(asset);
                                }));
}

/// Licences that allow less than the dataset's, which then promises what is not the maker's to give.
void check_beyond(const CheckInput& input, CheckReport& report) {
  const std::optional<Terms> own = terms_of(input.dataset.licence);
  if (!own) return;
  std::vector<std::string> narrower;
  AssetNames assets;
  for (const LicenceRecord& licence : input.dataset.licences) {
    const std::optional<Terms> terms = terms_of(licence.spdx);
    const std::string beyond = terms ? allowed_beyond(*terms, *own) : "";
    if (beyond.empty()) continue;
    narrower.push_back(fmt::format("{} (not {})", licence.spdx, beyond));
    assets.add(licence.assets);
  }
  report.add(CheckLevel::warning,
             fmt::format("licences of models and scenes allow less than the dataset's, {}",
                         input.dataset.licence),
             narrower, input.dataset.licences.size(),
             "dataset.licence may allow no more than they all do",
             ids_showing(input, [&](const std::string& asset) { return assets.has(asset); }));
}

void check_licences(const CheckInput& input, CheckReport& report) {
  std::set<std::string> assets;
  for (const ImageRecord& image : input.images)
    for (std::string& asset : shown_assets(image, input.dataset))
      assets.insert(std::move(asset));
  AssetNames unknown;
  std::vector<std::string> unnamed, limited;
  for (const LicenceRecord& licence : input.dataset.licences) {
    if (licence.spdx.empty()) unknown.add(licence.assets);
    for (const char* part : {"-NC", "-ND", "-SA", "GPL"})
      if (licence.spdx.find(part) != licence.spdx.npos) {
        limited.push_back(licence.spdx);
        break;
      }
  }
  std::copy_if(assets.begin(), assets.end(), std::back_inserter(unnamed),
               [&](const std::string& asset) { return unknown.has(asset); });
  if (input.dataset.licence.empty())
    report.say(
        CheckLevel::note, "the dataset names no licence",
        "dataset.licence says what others may do with the pictures; it is yours to give as far "
        "as the models' licences allow");
  check_missing(input, report, assets);
  check_beyond(input, report);
  report.add(CheckLevel::note,
             "models and scenes have a licence text that is none of those known by name (SPDX)",
             unnamed, assets.size(), "", std::vector<std::string>());
  report.add(CheckLevel::note,
             "licences of models and scenes have limits: no commerce, no changes, or the same "
             "licence only",
             limited, input.dataset.licences.size(), "", std::vector<std::string>());
}

}  // namespace

Check licences_check() {
  return {"licences", "assets without a licence, or with one that limits use", check_licences};
}

}  // namespace ds

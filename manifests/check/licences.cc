// SPDX-License-Identifier: Apache-2.0
// Models, materials and environments without a licence, or with one that not every use may have.
#include "manifests/check/check.h"
#include "manifests/shown_assets.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <set>

namespace ds {
namespace {

/// Where some have one.
void check_missing(const CheckInput& input, CheckReport& report) {
  AssetNames licensed;
  for (const LicenceRecord& licence : input.dataset.licences)
    licensed.add(licence.assets);
  std::set<std::string> assets, without;
  for (const ImageRecord& image : input.images)
    for (const std::string& asset : shown_assets(image, input.dataset)) {
      assets.insert(asset);
      if (!licensed.has(asset)) without.insert(asset);
    }
  report.add(CheckLevel::note, "models and scenes have no licence beside them",
             {without.begin(), without.end()}, assets.size(), "a LICENSE file in their folders",
             ids_where(input.images, [&](const ImageRecord& image) {
               for (const std::string& asset : shown_assets(image, input.dataset))
                 if (without.contains(asset)) return true;
               return false;
             }));
}

void check_licences(const CheckInput& input, CheckReport& report) {
  std::set<std::string> licensed;
  std::vector<std::string> unnamed, limited;
  for (const LicenceRecord& licence : input.dataset.licences) {
    licensed.insert(licence.assets.begin(), licence.assets.end());
    if (licence.spdx.empty())
      unnamed.insert(unnamed.end(), licence.assets.begin(), licence.assets.end());
    for (const char* part : {"-NC", "-ND", "-SA", "GPL"})
      if (licence.spdx.find(part) != licence.spdx.npos) {
        limited.push_back(licence.spdx);
        break;
      }
  }
  if (input.dataset.licence.empty())
    report.say(
        CheckLevel::note, "the dataset names no licence",
        "dataset.licence says what others may do with the pictures; it is yours to give as far "
        "as the models' licences allow");
  if (licensed.empty())
    report.say(CheckLevel::warning, "no licence stands beside any model or scene",
               "a LICENSE file in their folders");
  else
    check_missing(input, report);
  report.add(CheckLevel::note,
             "models and scenes have a licence text that is none of those known by name (SPDX)",
             unnamed, licensed.size(), "", std::vector<std::string>());
  report.add(CheckLevel::note, "licences allow not every use, or want the same of what is made",
             limited, input.dataset.licences.size(), "", std::vector<std::string>());
}

}  // namespace

Check licences_check() {
  return {"licences", "assets without a licence, or with one that limits use", check_licences};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/sources.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {

std::string first_url(std::string_view text) {
  std::size_t at = text.npos;
  for (const std::string_view scheme : {"http://", "https://"})
    at = std::min(at, text.find(scheme));
  if (at == text.npos) return "";
  std::string_view url = text.substr(at);
  url = url.substr(0, url.find_first_of(" \t\r\n\"'<>`"));
  const std::size_t host = url.find("//") + 2;
  while (url.size() > host && std::string_view(".,;:!?)]").find(url.back()) != url.npos)
    url.remove_suffix(1);
  return std::string(url.size() > host ? url : "");
}

std::vector<SourceRecord> group_sources(
    const std::vector<std::pair<std::string, std::string>>& texts) {
  std::map<std::string_view, std::set<std::string>> assets;
  for (const auto& [asset, text] : texts)
    assets[text].insert(asset);
  std::vector<SourceRecord> sources;
  for (const auto& [text, names] : assets)
    sources.push_back({first_url(text), std::string(text), {names.begin(), names.end()}});
  std::sort(sources.begin(), sources.end(),
            [](const SourceRecord& a, const SourceRecord& b) { return a.assets < b.assets; });
  return sources;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/licences.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace ds {
namespace {

/// Words that a licence's text holds, in lower case with single spaces, and no other known one's.
struct KnownLicence {
  std::string_view id;
  std::string_view words;
  std::string_view without = "";  ///< words that make it another licence
};
constexpr KnownLicence k_known[] = {
    {"CC0-1.0", "cc0 1.0 universal"},
    {"CC-BY-3.0", "creative commons attribution 3.0"},
    {"CC-BY-4.0", "attribution 4.0 international"},
    {"CC-BY-SA-4.0", "attribution-sharealike 4.0 international"},
    {"CC-BY-NC-4.0", "attribution-noncommercial 4.0 international"},
    {"CC-BY-NC-SA-4.0", "attribution-noncommercial-sharealike 4.0 international"},
    {"CC-BY-ND-4.0", "attribution-noderivatives 4.0 international"},
    {"CC-BY-NC-ND-4.0", "attribution-noncommercial-noderivatives 4.0 international"},
    {"MIT",
     "permission is hereby granted, free of charge, to any person obtaining a copy of this "
     "software and associated documentation files"},
    {"Apache-2.0", "apache license version 2.0"},
    {"BSD-3-Clause",
     "endorse or promote products derived from this software without specific "
     "prior written permission"},
    {"BSD-2-Clause", "redistribution and use in source and binary forms",
     "endorse or promote products"},
    {"ISC",
     "permission to use, copy, modify, and/or distribute this software for any purpose with "
     "or without fee is hereby granted"},
    {"Unlicense", "this is free and unencumbered software released into the public domain"},
    {"ODbL-1.0", "open database license (odbl) v1.0"},
    {"ODC-By-1.0", "open data commons attribution license v1.0"},
    {"PDDL-1.0", "odc public domain dedication and licence"},
};

/// The text in lower case, each run of white space as one space.
std::string plain_words(std::string_view text) {
  std::string words;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (blank && (words.empty() || words.back() == ' ')) continue;
    words += blank ? ' ' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  // "Apache License, Version 2.0" too.
  for (std::size_t at = words.find("license, "); at != words.npos; at = words.find("license, "))
    words.erase(at + 7, 1);
  return words;
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

/// What stands behind one of the words, from a . - or _ on, less an ending of a text; nothing where none of
/// the words begins the name.
std::optional<std::string> behind_word(std::string_view name,
                                       std::initializer_list<std::string_view> words) {
  const std::string lower = in_lower_case(name);
  for (const std::string_view word : words) {
    if (!lower.starts_with(word)) continue;
    std::string rest = lower.substr(word.size());
    if (!rest.empty() && std::string_view(".-_").find(rest[0]) == std::string_view::npos) continue;
    for (const char* ending : {".txt", ".md", ".rst", ".markdown", ".text"})
      if (rest.ends_with(ending)) return rest.substr(0, rest.rfind('.'));
    return rest;
  }
  return std::nullopt;
}

/// What stands behind "SPDX-License-Identifier:" on its line; "" where there is none.
std::string stated_id(std::string_view text) {
  constexpr std::string_view k_tag = "SPDX-License-Identifier:";
  const std::size_t at = text.find(k_tag);
  if (at == text.npos) return "";
  std::string_view line = text.substr(at + k_tag.size());
  line = line.substr(0, line.find_first_of("\r\n"));
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t end = line.find_last_not_of(" \t*/->") + 1;  // a comment's end is none of it
  return std::string(line.substr(begin, end > begin ? end - begin : 0));
}

}  // namespace

std::string spdx_id(std::string_view text) {
  if (std::string id = stated_id(text); !id.empty()) return id;
  const std::string words = plain_words(text);
  std::string_view found;
  for (const KnownLicence& known : k_known) {
    if (words.find(known.words) == words.npos) continue;
    if (!known.without.empty() && words.find(known.without) != words.npos) continue;
    if (!found.empty()) return "";
    found = known.id;
  }
  return std::string(found);
}

bool is_licence_name(std::string_view name) {
  const auto rest = behind_word(
      name, {"licenses", "licences", "license", "licence", "copying", "unlicense", "unlicence"});
  if (!rest) return false;
  const std::string_view last =
      std::string_view(*rest).substr(std::min(rest->rfind('.'), rest->size()));
  // An ending of letters alone is a file format's, but for what licences are called.
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (last.empty() || std::any_of(last.begin(), last.end(), is_digit)) return true;
  constexpr std::string_view k_known_endings[] = {".lesser", ".mit",  ".bsd",  ".apache",
                                                  ".gpl",    ".lgpl", ".cc-by"};
  return std::find(std::begin(k_known_endings), std::end(k_known_endings), last) !=
         std::end(k_known_endings);
}

bool is_licence_folder_name(std::string_view name) {
  const std::string lower = in_lower_case(name);
  return lower == "licenses" || lower == "licences";
}

bool is_source_name(std::string_view name) {
  const auto rest = behind_word(name, {"sources", "source"});
  return rest && rest->empty();
}

std::vector<LicenceRecord> group_licences(
    const std::vector<std::pair<std::string, std::string>>& texts) {
  std::map<std::string_view, std::set<std::string>> assets;
  for (const auto& [asset, text] : texts)
    assets[text].insert(asset);
  std::vector<LicenceRecord> licences;
  for (const auto& [text, names] : assets)
    licences.push_back({spdx_id(text), std::string(text), {names.begin(), names.end()}});
  std::sort(licences.begin(), licences.end(),
            [](const LicenceRecord& a, const LicenceRecord& b) { return a.assets < b.assets; });
  return licences;
}

}  // namespace ds

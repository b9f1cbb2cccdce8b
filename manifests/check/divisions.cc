// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/divisions.h"

#include "tracer/base/error.h"

#include <set>

namespace ds {

bool Division::parts(const ImageRecord& a, const ImageRecord& b) const {
  const std::optional<std::string> of_a = part_of(a), of_b = part_of(b);
  return of_a && of_b && *of_a != *of_b;
}

std::vector<Division> divisions_of(const std::vector<ImageRecord>& images) {
  std::vector<Division> divisions;
  for (const Division& division :
       {Division{"split", "splits",
                 [](const ImageRecord& image) { return std::optional<std::string>(image.split); }},
        Division{"fold", "folds", [](const ImageRecord& image) {
                   return image.fold ? std::optional(fmt::format("fold {}", *image.fold))
                                     : std::nullopt;
                 }}}) {
    std::set<std::string> parts;
    for (const ImageRecord& image : images)
      if (const std::optional<std::string> part = division.part_of(image)) parts.insert(*part);
    if (parts.size() > 1) divisions.push_back(division);
  }
  return divisions;
}

std::string split_by(const CheckInput& input) {
  const std::string literal = input.setting("classes.split.by");
  return literal.size() < 2 ? "model" : literal.substr(1, literal.size() - 2);
}

std::string_view divided_by(const ImageRecord& a, const ImageRecord& b) {
  if (a.split != b.split) return "split";
  return a.fold && b.fold && *a.fold != *b.fold ? "fold" : "";
}

std::uint64_t pairs_apart(const std::map<std::string, std::uint64_t>& counts) {
  std::uint64_t pairs = 0, before = 0;
  for (const auto& [part, count] : counts) {
    pairs += before * count;
    before += count;
  }
  return pairs;
}

std::string name_in(std::string_view name, std::string_view part) {
  return part.empty() ? std::string(name) : fmt::format("{} ({})", name, part);
}

}  // namespace ds

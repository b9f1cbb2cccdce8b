// SPDX-License-Identifier: Apache-2.0
// Pictures of equal pixels: one view seen twice, or a change that no picture shows.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {
namespace {

void check_duplicates(const CheckInput& input, CheckReport& report) {
  std::map<Hash128, std::vector<const ImageRecord*>> same;
  std::uint64_t pictures = 0;
  for (const ImageRecord& image : input.images)
    for (const FileRecord& file : image.files)
      if (file.kind == "image") {
        same[file.pixels].push_back(&image);
        ++pictures;
      }
  std::map<std::string_view, std::vector<std::string>> found;  // by divided_by
  std::map<std::string_view, std::set<Hash128>> of;
  for (const auto& [pixels, images] : same) {
    if (images.size() < 2) continue;
    const auto any = [&, first = images[0]](std::string_view division) {
      return std::any_of(images.begin(), images.end(), [&](const ImageRecord* image) {
        return divided_by(*first, *image) == division;
      });
    };
    const std::string_view division = any("split") ? "split" : any("fold") ? "fold" : "";
    of[division].insert(pixels);
    for (std::size_t i = 1; i < images.size(); ++i)
      found[division].push_back(images[i]->id + " as " + images[0]->id);
  }
  const auto add = [&](std::string_view division, CheckLevel level, std::string what,
                       const char* advice) {
    report.add(level, std::move(what), found[division], pictures, advice,
               ids_where(input.images, [&](const ImageRecord& image) {
                 return std::any_of(
                     image.files.begin(), image.files.end(), [&](const FileRecord& file) {
                       return file.kind == "image" && of[division].contains(file.pixels);
                     });
               }));
  };
  for (const std::string_view division : {"split", "fold"})
    add(division, CheckLevel::error,
        fmt::format("pictures have the pixels of one in another {}", division),
        "what is tested was seen in training");
  add("", CheckLevel::warning, "pictures have the pixels of another", "");
}

}  // namespace

Check duplicates_check() {
  return {"duplicates", "pictures of equal pixels", check_duplicates};
}

}  // namespace ds

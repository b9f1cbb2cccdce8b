// SPDX-License-Identifier: Apache-2.0
// Pictures of equal pixels: one view seen twice, or a change that no picture shows.
#include "manifests/check/check.h"

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
  std::vector<std::string> within, across;
  std::set<Hash128> in_one, in_several;
  for (const auto& entry : same) {
    const std::vector<const ImageRecord*>& images = entry.second;
    if (images.size() < 2) continue;
    const bool one_split = std::all_of(images.begin(), images.end(), [&](const ImageRecord* image) {
      return image->split == images[0]->split;
    });
    (one_split ? in_one : in_several).insert(entry.first);
    for (std::size_t i = 1; i < images.size(); ++i)
      (one_split ? within : across).push_back(images[i]->id + " as " + images[0]->id);
  }
  const auto of = [&](const std::set<Hash128>& wanted) {
    return ids_where(input.images, [&](const ImageRecord& image) {
      return std::any_of(image.files.begin(), image.files.end(), [&](const FileRecord& file) {
        return file.kind == "image" && wanted.contains(file.pixels);
      });
    });
  };
  report.add(CheckLevel::error, "pictures have the pixels of one in another split", across,
             pictures, "what is tested was seen in training", of(in_several));
  report.add(CheckLevel::warning, "pictures have the pixels of another", within, pictures, "",
             of(in_one));
}

}  // namespace

Check duplicates_check() {
  return {"duplicates", "pictures of equal pixels", check_duplicates};
}

}  // namespace ds

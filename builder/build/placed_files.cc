// SPDX-License-Identifier: Apache-2.0
#include "builder/build/placed_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

namespace ds {

std::string PlacedFiles::why_not_in_place(const std::string& image_id, const OutputFile& output) {
  const auto found = placed_.find(output.path);
  if (found == placed_.end() || found->second.image != image_id)
    return output.path + " was never made";
  PlacedFile& placed = found->second;
  if (placed.product != output.key) return output.path + " is of an older key";
  const std::filesystem::path file = dataset_.folder / output.path;
  const std::optional<FileStamp> stamp = stamp_of(file);
  if (!stamp) return output.path + " is missing";
  if (placed.stamp == stamp && stamps_ == Stamps::trust) return "";
  if (hash_file(file).xxh128 != placed.object) return output.path + " was changed on the disk";
  placed.stamp = stamp;
  restamped_.push_back(placed);
  return "";
}

bool PlacedFiles::all_in_place(const PlannedImage& image) {
  return std::all_of(
      image.keys.outputs.begin(), image.keys.outputs.end(),
      [&](const OutputFile& output) { return why_not_in_place(image.spec.id, output).empty(); });
}

std::vector<std::string> PlacedFiles::left_over(const std::vector<PlannedImage>& images,
                                                Shard shard) const {
  std::set<std::string> wanted;
  for (const PlannedImage& image : images)
    for (const OutputFile& output : image.keys.outputs)
      wanted.insert(output.path);
  std::vector<std::string> paths;
  for (const auto& [path, placed] : placed_)
    if (placed.kind != k_manifest_kind && !wanted.contains(path) && shard.holds(placed.image))
      paths.push_back(path);
  return paths;
}

void PlacedFiles::remember_stamps() {
  if (restamped_.empty()) return;
  Transaction transaction(dataset_.database->connection());
  for (const PlacedFile& file : restamped_)
    dataset_.database->put_placed(dataset_.row.id, file);
  transaction.commit();
}

}  // namespace ds

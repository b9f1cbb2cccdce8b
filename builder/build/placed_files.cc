// SPDX-License-Identifier: Apache-2.0
#include "builder/build/placed_files.h"

#include "tracer/base/files.h"

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
  // Its permissions were changed, or an older dsbuild placed it for root: an editor would write into
  // the store.
  if (dataset_.store && dataset_.store->is_object(file, placed.object) && may_write(file))
    return output.path + " can be written to although it is one file with the store's";
  placed.stamp = stamp;
  restamped_.push_back(placed);
  return "";
}

bool PlacedFiles::all_in_place(const PlannedImage& image) {
  return std::all_of(
      image.keys.outputs.begin(), image.keys.outputs.end(),
      [&](const OutputFile& output) { return why_not_in_place(image.spec.id, output).empty(); });
}

bool PlacedFiles::in_place(const ImageRecord& record) {
  return std::all_of(record.files.begin(), record.files.end(), [&](const FileRecord& wanted) {
    const std::filesystem::path file = dataset_.folder / wanted.path;
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return false;
    const auto found = placed_.find(wanted.path);
    if (found != placed_.end() && found->second.object == wanted.hashes.xxh128 &&
        found->second.stamp == stamp)
      return true;
    return hash_file(file).xxh128 == wanted.hashes.xxh128;
  });
}

const PlacedFile* PlacedFiles::find(const std::string& path) const {
  const auto found = placed_.find(path);
  return found != placed_.end() ? &found->second : nullptr;
}

std::vector<std::string> PlacedFiles::left_over(const std::vector<PlannedImage>& images,
                                                Shard shard) const {
  // The recipe names the files of images too that cannot be made now.
  std::set<std::string> wanted;
  for (const PlannedImage& image : images)
    if (!image.refused)
      for (std::string& path : output_paths(dataset_.recipe.outputs, image.spec.id))
        wanted.insert(std::move(path));
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

// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/placed_files.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <limits>
#include <optional>
#include <unistd.h>

namespace ds {

namespace {

constexpr std::size_t k_manifest_rows = 3;

}  // namespace

PlacedFiles::PlacedFiles(Dataset& dataset, Stamps stamps)
    : dataset_(dataset),
      stamps_(stamps),
      folder_(::open(dataset.folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC)) {
  // Grown by doubling, they would take three times as much for a moment.
  rows_.reserve(image_count(dataset.recipe) * output_paths(dataset.recipe.outputs, "").size() +
                k_manifest_rows);
  dataset.database->visit_placed(dataset.row.id, [&](const PlacedView& row) {
    DS_ASSERT(names_.size() <= std::numeric_limits<std::uint32_t>::max());
    rows_.push_back({hash_text(row.path), hash_text(row.image), row.product, row.object, row.stamp,
                     static_cast<std::uint32_t>(names_.size()), row.kind == k_manifest_kind});
    names_.append(row.path).push_back('\0');
  });
  by_path_ = HashIndex(rows_.size(), [&](std::size_t i) { return rows_[i].path; });
  if (stamps_ != Stamps::trust) return;
  ahead_ = std::make_unique<StampsAhead>(folder_, rows_.size(), [this](std::size_t i) {
    const Row& row = rows_[i];
    return StampsAhead::File{names_.c_str() + row.name, row.stamp ? &*row.stamp : nullptr};
  });
}

PlacedFiles::~PlacedFiles() {
  ahead_.reset();
  if (folder_ >= 0) ::close(folder_);
}

std::optional<std::size_t> PlacedFiles::find_row(std::string_view path) const {
  return by_path_.find(hash_text(path), [&](std::size_t i) { return rows_[i].path; });
}

const PlacedFiles::Row* PlacedFiles::find(std::string_view path) const {
  const auto row = find_row(path);
  return row ? &rows_[*row] : nullptr;
}

/// The stamp of the file that lies there now; the row's where that was seen to be so already.
std::optional<FileStamp> PlacedFiles::look_at(const Row* placed, const std::string& path) const {
  if (folder_ < 0) return std::nullopt;
  if (placed != nullptr && ahead_ &&
      ahead_->is_known(static_cast<std::size_t>(placed - rows_.data())))
    return placed->stamp;
  return stamp_in(folder_, path.c_str());
}

std::string PlacedFiles::why_not_in_place(const std::string& image_id, const OutputFile& output) {
  const Row* placed = find(output.path);
  if (placed == nullptr || placed->image != hash_text(image_id))
    return output.path + " was never made";
  if (placed->product != output.key) return output.path + " is of an older key";
  const std::optional<FileStamp> stamp = look_at(placed, output.path);
  if (!stamp) return output.path + " is missing";
  if (placed->stamp == stamp && stamps_ == Stamps::trust) return "";
  const std::filesystem::path file = dataset_.folder / output.path;
  if (content_hash(file) != placed->object) return output.path + " was changed on the disk";
  // Its permissions were changed, or an older dsbuild placed it for root: an editor would write into
  // the store.
  if (dataset_.store && dataset_.store->is_object(file, placed->object) && may_write(file))
    return output.path + " can be written to although it is one file with the store's";
  rows_[static_cast<std::size_t>(placed - rows_.data())].stamp = stamp;
  restamped_.push_back(
      {output.path, image_id, output.kind, placed->product, placed->object, stamp});
  return "";
}

bool PlacedFiles::all_in_place(const std::string& image_id,
                               const std::vector<OutputFile>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [&](const OutputFile& output) {
    return why_not_in_place(image_id, output).empty();
  });
}

std::optional<Hash128> PlacedFiles::bytes_in_place(const std::string& path) const {
  const Row* placed = find(path);
  const std::optional<FileStamp> stamp = look_at(placed, path);
  if (!stamp) return std::nullopt;
  if (placed != nullptr && placed->stamp == stamp && stamps_ == Stamps::trust)
    return placed->object;
  return content_hash(dataset_.folder / path);
}

PlacedFiles::Found PlacedFiles::find_there(const std::string& path) const {
  const Row* placed = find(path);
  try {
    const std::optional<Hash128> bytes = bytes_in_place(path);
    if (!bytes) return Found::nothing;
    if (placed != nullptr && bytes == placed->object) return Found::ours;
    // A build may have placed what the store has, and not come to note it.
    const bool of_manifest = placed != nullptr && placed->of_manifest;
    return !of_manifest && dataset_.store && dataset_.store->has(*bytes) ? Found::ours
                                                                         : Found::edited;
  } catch (const Error&) {
    return Found::unreadable;
  }
}

std::vector<std::string> PlacedFiles::left_over(const std::vector<PlannedImage>& images,
                                                Shard shard) const {
  std::vector<bool> wanted(rows_.size());
  const auto want = [&](const std::string& path) {
    if (const auto row = find_row(path)) wanted[*row] = true;
  };
  for (const PlannedImage& image : images) {
    if (image.refused) continue;
    for (const OutputFile& output : image.keys.outputs)
      want(output.path);
    if (!image.error) continue;
    // The recipe names the files of images too that cannot be made now.
    for (const std::string& path : output_paths(dataset_.recipe.outputs, image.spec.id))
      want(path);
  }
  bool any = false;
  for (std::size_t i = 0; i < rows_.size() && !any; ++i)
    any = !rows_[i].of_manifest && !wanted[i];
  std::vector<std::string> paths;
  if (!any) return paths;
  // Their names are in the database only.
  dataset_.database->visit_placed(dataset_.row.id, [&](const PlacedView& row) {
    const auto known = find_row(row.path);
    if (row.kind != k_manifest_kind && shard.holds(row.image) && !(known && wanted[*known]))
      paths.emplace_back(row.path);
  });
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

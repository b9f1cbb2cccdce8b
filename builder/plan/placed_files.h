// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/stamps_ahead.h"
#include "builder/plan/hash_index.h"
#include "builder/plan/plan.h"
#include "builder/store/dataset.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The files that builds put into a dataset's folder: as the database knew them when this was made,
/// and as they lie on the disk. A file is looked at once, between when this was made and when it is
/// first asked for. 150 bytes a file: there may be 100,000.
class PlacedFiles {
 public:
  /// What the database knew of a file; path and image by their hashes.
  struct Row {
    Hash128 path, image, product, object;
    std::optional<FileStamp> stamp;
    std::uint32_t name = 0;  ///< where the path starts in `names_`
    bool of_manifest = false;
  };

  /// The dataset must outlive it.
  explicit PlacedFiles(Dataset& dataset, Stamps stamps = Stamps::trust);
  ~PlacedFiles();
  PlacedFiles(const PlacedFiles&) = delete;
  PlacedFiles& operator=(const PlacedFiles&) = delete;

  /// Empty where the file is there and what its key says, else why it is not. Reads a file whose
  /// stamp is not the one remembered. Throws Error(io).
  std::string why_not_in_place(const std::string& image_id, const OutputFile& output);
  /// Whether that holds for every file of the image. Its keys must be known.
  bool all_in_place(const std::string& image_id, const std::vector<OutputFile>& outputs);
  bool all_in_place(const PlannedImage& image) {
    return all_in_place(image.spec.id, image.keys.outputs);
  }
  /// Hash of the bytes of the file that is there now, whatever put them there; nothing where there
  /// is none. Reads it where its stamp is not the one remembered. Throws Error(io).
  std::optional<Hash128> bytes_in_place(const std::string& path) const;
  /// What lies where a file of the dataset is, or is to be.
  enum class Found {
    nothing,  ///< or no file
    ours,     ///< what a build put there; or what the store has, so that nobody's work is in it
    edited,   ///< bytes that no build is known to have written
    unreadable,
  };
  Found find_there(const std::string& path) const;
  /// What the database knew of a file; null where nothing.
  const Row* find(std::string_view path) const;
  /// The files of the shard's images that are of none of these images, or of one whose picture is
  /// refused; relative to the folder.
  std::vector<std::string> left_over(const std::vector<PlannedImage>& images, Shard shard) const;
  /// Writes the stamps of the files that were read and found whole.
  void remember_stamps();

 private:
  std::optional<std::size_t> find_row(std::string_view path) const;
  std::optional<FileStamp> look_at(const Row* placed, const std::string& path) const;

  Dataset& dataset_;
  Stamps stamps_;
  int folder_;  ///< descriptor; -1 where there is no folder
  std::vector<Row> rows_;
  std::string names_;  ///< the paths, each with a 0 behind it
  HashIndex by_path_;
  std::vector<PlacedFile> restamped_;
  std::unique_ptr<StampsAhead> ahead_;  ///< the last member: its thread reads the others
};

}  // namespace ds

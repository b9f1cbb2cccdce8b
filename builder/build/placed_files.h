// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/build/dataset.h"
#include "builder/build/plan.h"
#include "manifests/manifest.h"

#include <map>
#include <string>
#include <vector>

namespace ds {

/// The files that builds put into a dataset's folder: as the database knew them when this was made,
/// and as they lie on the disk when it is asked.
class PlacedFiles {
 public:
  /// The dataset must outlive it.
  explicit PlacedFiles(Dataset& dataset, Stamps stamps = Stamps::trust)
      : dataset_(dataset),
        stamps_(stamps),
        placed_(dataset.database->placed_files(dataset.row.id)) {}

  /// Empty where the file is there and what its key says, else why it is not. Reads a file whose
  /// stamp is not the one remembered. Throws Error(io).
  std::string why_not_in_place(const std::string& image_id, const OutputFile& output);
  /// Whether that holds for every file of the image. Its keys must be known.
  bool all_in_place(const PlannedImage& image);
  /// Whether every file of a manifest's line is there with the bytes that it says.
  bool in_place(const ImageRecord& record);
  /// What the database knew of a file; null where nothing.
  const PlacedFile* find(const std::string& path) const;
  /// The files of the shard's images that are of none of these images, or of one whose picture is
  /// refused; relative to the folder.
  std::vector<std::string> left_over(const std::vector<PlannedImage>& images, Shard shard) const;
  /// Writes the stamps of the files that were read and found whole.
  void remember_stamps();

 private:
  Dataset& dataset_;
  Stamps stamps_;
  std::map<std::string, PlacedFile> placed_;
  std::vector<PlacedFile> restamped_;
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <cstddef>
#include <string>
#include <vector>

namespace ds {

/// A file of an image that is in both datasets and has other bytes, or is in one of them alone.
struct ChangedFile {
  const FileRecord* a = nullptr;  ///< null where that dataset has none
  const FileRecord* b = nullptr;
  const FileRecord& either() const { return a != nullptr ? *a : *b; }
  /// Other bytes of the same pixels: another encoder, or other metadata.
  bool is_same_picture() const { return a != nullptr && b != nullptr && a->pixels == b->pixels; }
};

struct ChangedImage {
  const ImageRecord* a = nullptr;
  const ImageRecord* b = nullptr;
  /// Of "model", "material", "environment", "camera", "engine": what its render key is made of. Not
  /// the engine where only its program is another since the material, environment or lens is, nor
  /// the model where only what another material reads of it is.
  std::vector<std::string> parts;
  /// Other fields of its line in the manifest, sorted: "class", "split", "seed". Keys, and what is read
  /// off the picture, stand for files and parts that differ and are not named.
  std::vector<std::string> fields;
  std::vector<ChangedFile> files;
};

/// Two datasets by what their manifests say. Points into the records compared.
struct DatasetDifference {
  std::vector<const ImageRecord*> only_a, only_b;
  std::vector<ChangedImage> changed;  ///< by id
  std::size_t same = 0;               ///< images that are equal in all
  /// Fields of dataset.json that differ, sorted; counts and concerns, which follow from images, are not.
  std::vector<std::string> dataset_fields;

  bool images_differ() const { return !only_a.empty() || !only_b.empty() || !changed.empty(); }
};

/// Records as read_images_manifest gives them, ordered by id. Both must outlive the result.
DatasetDifference compare_datasets(const DatasetRecord& a, const std::vector<ImageRecord>& images_a,
                                   const DatasetRecord& b,
                                   const std::vector<ImageRecord>& images_b);

}  // namespace ds

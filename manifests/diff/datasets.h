// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// A file of an image that is in both datasets and has other bytes, or is in one of them alone.
struct ChangedFile {
  std::optional<FileRecord> a, b;  ///< none where that dataset has none
  const FileRecord& either() const { return a ? *a : *b; }
  /// Other bytes of the same pixels: another encoder, or other metadata.
  bool is_same_picture() const { return a && b && a->pixels == b->pixels; }
};

struct ChangedImage {
  std::string id;
  /// Of "model", "material", "environment", "camera", "engine": what its render key is made of. Not
  /// the engine where only its program is another since the material, environment or lens is, nor
  /// the model where only what another material reads of it is.
  std::vector<std::string> parts;
  /// Other fields of its line in the manifest, sorted: "class", "split", "seed". Keys, and what is read
  /// off the picture, stand for files and parts that differ and are not named.
  std::vector<std::string> fields;
  std::vector<ChangedFile> files;
};

/// Two datasets by what their manifests say.
struct DatasetDifference {
  std::vector<std::string> only_a, only_b;  ///< ids
  std::vector<ChangedImage> changed;        ///< by id
  std::size_t same = 0;                     ///< images that are equal in all
  /// Fields of dataset.json that differ, sorted; counts and concerns, which follow from images, are not.
  std::vector<std::string> dataset_fields;

  bool images_differ() const { return !only_a.empty() || !only_b.empty() || !changed.empty(); }
};

/// Of the manifests in two folders, which are read line by line side by side: only lines that are not the
/// same to the byte are taken apart, and only what differs is kept. No file of an image is read: what
/// the manifests say of them is taken for true. Throws as read_images_manifest and
/// read_dataset_manifest, of the first line that is wrong, and Error(asset) where ids do not ascend.
DatasetDifference compare_datasets(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ds {

struct ExportRequest {
  std::filesystem::path folder;  ///< of the dataset: its manifest and files are enough
  std::filesystem::path to;
  std::string format;               ///< of exporter_types()
  std::vector<std::string> splits;  ///< these only; empty: all
  /// ("class", "vehicle/*"): images of which that matches one pattern of each key that is named. Keys:
  /// class (or a class above it), model (with or without its ending), material, environment, view.
  /// Patterns: * any text, ? any character.
  std::vector<std::pair<std::string, std::string>> filters;
  std::string classes{};  ///< of DatasetRecord::hierarchies, in place of class_path; "": class_path
  bool copy = false;
  /// An image's model as its file has it, for formats that hold models; empty where only the dataset's
  /// folder is known.
  std::function<FileMesh(const ImageRecord&)> mesh{};
  /// Likewise, of a thing that images show beside their models.
  std::function<FileMesh(const ObjectRecord&)> object_mesh{};
  /// What readers must know of the dataset, as that its recipe wants more: a warning, and in the card.
  std::vector<std::string> notes{};
};

struct ExportResult {
  std::uint64_t images = 0, files = 0, bytes = 0;
  std::map<std::string, std::uint64_t> splits;  ///< images of each
  /// Images that are not exported, by why: "split", "filter", "unclassified".
  std::map<std::string, std::uint64_t> left_out;
  std::vector<std::string> notes;
};

/// Writes the dataset in a format that training jobs read. Depends on the dataset's files alone, and so
/// do its bytes. Throws Error(usage) for a format, split or key of a filter that is not there, an export
/// that would hold no image, and a folder that is in the way; Error(asset) where the dataset lacks what
/// the format needs, or a file is not what the manifest says. `progress`: images done of all. Stopped,
/// it throws Error(cancelled) and leaves nothing behind.
ExportResult export_dataset(const ExportRequest& request,
                            const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                            const std::atomic<bool>& stop);

/// What a model's part of a key is made of.
enum class KeyForm {
  stem,    ///< "mug" of "mug.ply"
  ending,  ///< "mug_ply"
  hash     ///< "mug_ply_1b2c3d4e", of its whole name
};
/// "mug-1-3" of the image "mug.ply/1-3" of the model "mug.ply". A model's name of over 64 bytes is cut and
/// has a hash.
std::string export_key(std::string_view id, std::string_view model, KeyForm form);

/// Whether the text is what the pattern says: * any text, ? any one character, else itself.
bool matches_pattern(std::string_view text, std::string_view pattern);

}  // namespace ds

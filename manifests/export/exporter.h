// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/export_folder.h"
#include "manifests/manifest.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ds {

/// Of 8 bit samples, one a pixel, row by row from the top: 255 where the model is seen.
struct MaskPixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> values;
};
/// x and y of the first pixel, width and height in pixels; nothing of a mask that shows nothing.
std::optional<std::array<int, 4>> tight_box(const MaskPixels& mask);

/// An image of the dataset that is exported.
struct ExportImage {
  ImageRecord record;
  /// "mug-1-3": one name for all formats, of no dot, slash or blank, no two images' the same.
  std::string key;
  std::string split;  ///< "train", "val", "test"; "train" in a dataset that has no splits
  int label = 0;      ///< of ExportInput::classes; -1 where it has no class
};

/// What is exported, the same for all of its images.
struct ExportInput {
  std::filesystem::path folder;  ///< the dataset's
  DatasetRecord dataset;
  /// Class paths: a label is the index of one. {"object"} in a dataset without classes.
  std::vector<std::string> classes;
  std::map<std::string, std::uint64_t> splits;  ///< images that are exported, by split
  /// Kinds of files that every image has, "image" first.
  std::vector<std::string> kinds;
  std::map<std::string, std::map<std::string, std::uint64_t>>
      counts;                                     ///< images by class and split
  std::map<std::string, std::uint64_t> left_out;  ///< images that are not exported, by why
  std::vector<std::string> unlicensed;  ///< models, materials, environments without a licence
  std::vector<std::string> unsourced;   ///< likewise, of which nothing says where they come from
  std::vector<std::string> filters;     ///< "class=vehicle/*", "split=test": what was asked for
  std::string size;                     ///< "256 x 256", or "of several sizes"
  std::function<FileMesh(const ImageRecord&)> mesh;  ///< as in ExportRequest
  std::function<FileMesh(const ObjectRecord&)> object_mesh;
  bool has_classes = false;  ///< else all things are of the one class "object"
  bool of_hierarchy =
      false;  ///< classes are those of a further classification, which models alone have

  bool has(const std::string& kind) const;
  /// Of a thing beside the model; -1 where it has none of the classes.
  int label_of(const std::string& class_path) const;
};

/// Writes one format into a folder. Images come ordered by id.
class Exporter {
 public:
  virtual ~Exporter() = default;
  virtual void add(const ExportImage& image) = 0;
  virtual void finish() = 0;
  /// Lines for the front matter of the export's card, once it is finished. Without any, Hugging Face's datasets
  /// makes labels of folders' names, whatever they are: these say that nothing here is for it.
  virtual std::string card_lines() const {
    return "viewer: false\nconfigs:\n- config_name: default\n  data_files: []\n";
  }
};

/// A format of `dsbuild export`: NAME.cc and its line in CMakeLists.txt.
struct ExporterType {
  const char* name;
  const char* help;                ///< one line
  std::vector<const char*> needs;  ///< kinds of files without which there is no such export
  std::vector<const char*> takes;  ///< kinds that it has a place for; empty: all
  bool needs_labels;               ///< images without class or split have no place in it
  std::unique_ptr<Exporter> (*make)(const ExportInput& input, ExportFolder& to);
  bool lists_objects = false;  ///< that images show beside their models
  /// What the export's numbers are, for its card; null: boxes, world and cameras as in the manifest.
  const char* conventions = nullptr;
};

/// `make` of a format.
template <typename T>
std::unique_ptr<Exporter> make_exporter(const ExportInput& input, ExportFolder& to) {
  return std::make_unique<T>(input, to);
}

/// In alphabetical order.
std::span<const ExporterType> exporter_types();
/// Null where there is none of this name.
const ExporterType* find_exporter(std::string_view name);

/// The image's file of that kind, which must be there.
const FileRecord& file_of(const ExportImage& image, std::string_view kind);
/// The image's K. Error(asset) where its camera's rays are parallel, which `format` has no place for.
const std::array<double, 9>& intrinsics_for(const char* format, const ImageRecord& record);
/// ".png" of "images/mug.ply/0.mask.png".
std::string ending_of(const FileRecord& file);
/// The mask as it lies in the dataset; Error(asset) where its bytes are not those of the manifest.
MaskPixels read_mask(const ExportInput& input, const ExportImage& image,
                     std::string_view kind = "mask");

}  // namespace ds

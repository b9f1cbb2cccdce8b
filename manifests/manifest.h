// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tracer/base/hash.h"

namespace ds {

/// One file of a dataset.
struct FileRecord {
  std::string path;  ///< relative to the dataset's folder, "/" between parts
  std::string kind;  ///< "image", "mask", "depth"
  FileHashes hashes;
  Hash128 pixels;    ///< of the decoded pixels: what two machines with different encoders agree on
};

/// One image of a dataset: a line of manifest/images.jsonl. Holds no wall-clock time and no device.
struct ImageRecord {
  std::string id, model, class_path, split, material, environment, view;
  std::vector<FileRecord> files;
  std::uint64_t seed = 0;
  int spp = 0, width = 0, height = 0;
  std::string math;                            ///< "strict" or "fast"
  std::array<double, 9> intrinsics{};          ///< K, row-major, pixels; pixel centres at .5, origin top left
  std::array<double, 16> camera_to_world{};    ///< row-major; OpenCV camera (x right, y down, z forward), world Z up, metres
  double lens_radius_m = 0, focus_distance_m = 0;
  double tone_map_scale = 1;                   ///< the factor used (autolinear's differs from image to image)
  std::uint64_t rejected_samples = 0;
  Hash128 render_key, files_key;
  std::array<Hash128, 5> parts{};              ///< model, material, environment, camera, engine
};

struct DatasetRecord {
  std::string name, licence, recipe_text;      ///< recipe_text: canonical, no path of this machine
  std::string dsbuild_version;
  std::uint64_t seed = 0;
  std::vector<std::string> class_paths;
  std::vector<std::pair<std::string, std::uint64_t>> counts;  ///< "images", "models", "train", ...
  std::vector<std::pair<std::string, std::string>> licences;  ///< asset -> licence text found beside it
};

/// Canonical JSON: keys sorted, no spaces, shortest numbers that read back exactly, one line.
std::string to_json_line(const ImageRecord& image);
ImageRecord image_from_json_line(const std::string& line, const std::string& file, int line_number);

/// Writes manifest/images.jsonl, manifest/dataset.json and manifest/checksums.xxh128 under `folder`, each atomically;
/// images in the order of their ids. checksums is what `xxhsum -c` reads from inside `folder`.
void write_manifest(const std::filesystem::path& folder, const DatasetRecord& dataset,
                    const std::vector<ImageRecord>& images);
/// Throws Error(asset) where it is missing or damaged.
std::vector<ImageRecord> read_images_manifest(const std::filesystem::path& folder);

/// Intrinsics of a perspective camera of full angle fov_deg over the longer side, square pixels.
std::array<double, 9> camera_intrinsics(double fov_deg, int width, int height);

}  // namespace ds

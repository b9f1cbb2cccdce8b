// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/camera_geometry.h"
#include "manifests/concerns.h"
#include "manifests/draws.h"
#include "manifests/licences.h"
#include "manifests/model_pose.h"
#include "manifests/pixel_counts.h"
#include "manifests/sources.h"
#include "tracer/base/hash.h"
#include "tracer/render/render.h"
#include "tracer/scene/mesh.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// The manifest of a dataset's folder, three files under manifest/. No wall-clock time, no device,
/// no path of this machine stands in them, so two machines that make the same pictures write the
/// same bytes.
///
///   images.jsonl
///       one canonical JSON object a line and image, ordered by id (ImageRecord, same field names)
///   dataset.json
///       one JSON object (DatasetRecord), indented for reading
///   checksums.xxh128
///       "<32 hex digits>  <path>" a line, ordered by path: XXH3-128 of every file of the images
///       and of the two above; what `xxhsum -c manifest/checksums.xxh128` reads in the folder
///
/// Canonical: keys sorted by bytes, no spaces, numbers the shortest that read back exactly and
/// floats always with a point or an exponent, so that a column has one type, UTF-8 unescaped.
/// "format" in dataset.json counts up when a field changes its meaning; readers refuse what they do
/// not know. History:
///
///   1  "licences" an object of asset: text; floats without a point where they are whole
///   2  "licences" a list of {"spdx", "text", "assets"}, each text once; read as 2 is 1 too
inline constexpr int k_manifest_format = 2;
/// Counts up when lines or dataset.json gain a field, so that a build writes them anew. Readers need not
/// know it.
inline constexpr int k_manifest_fields = 6;

/// One file of a dataset.
struct FileRecord {
  std::string path;  ///< relative to the dataset's folder, "/" between parts
  std::string kind;  ///< "image", or a plane's name: "mask", "depth"
  FileHashes hashes;
  Hash128 pixels;  ///< of the decoded pixels: what two machines with different encoders agree on
};

/// A thing that an image shows beside its model: an element of "objects". It has "model_to_world", "model_box",
/// "box_m" and "model_to_camera" as the line has them of its model.
struct ObjectRecord {
  std::uint32_t id = 0;  ///< in the plane object_id
  std::string model, class_path, material;
  std::optional<std::uint64_t> class_id{};  ///< as ImageRecord::class_id
  ModelPose pose;
  /// "pixels", and what follows from them as from the model's: "box", "visible_fraction", "occlusion". Not
  /// there where the image has no plane.
  std::optional<ObjectCounts> pixels{};
  /// As the model's; null where the model's would be, and where the file of this one can no longer be read.
  std::optional<double> truncation{};
};

/// One image of a dataset: a line of manifest/images.jsonl.
struct ImageRecord {
  std::string id, model, class_path, split, material, environment, view;
  /// Index of DatasetRecord::class_paths; null in the file, and absent here, where it has no class.
  std::optional<std::uint64_t> class_id{};
  /// Of cross-validation; a field only where the image has one.
  std::optional<std::uint64_t> fold{};
  /// "classes": class path by DatasetRecord::hierarchies, "" for none. Not there where those are not.
  std::map<std::string, std::string> other_classes{};
  DrawRecords draws{};  ///< of distributions in the recipe; not there where those are not
  /// How often they were drawn until the recipe's camera.keep let the view pass; a field only where it asks
  /// something.
  std::optional<std::uint64_t> draw_attempts{};
  std::vector<FileRecord> files;
  std::uint64_t seed = 0;  ///< below 2^53, so that every JSON reader gets it exactly
  int spp = 0, width = 0, height = 0;
  std::string math;                          ///< "strict" or "fast"
  std::string camera_model = "perspective";  ///< a name of camera_types()
  /// As camera_intrinsics gives it; null for a camera whose rays are parallel.
  std::optional<std::array<double, 9>> intrinsics{};
  /// Of such a camera; a field only there. The picture's middle lies on the viewing axis.
  std::optional<double> metres_per_pixel{};
  std::array<double, 16> camera_to_world{};  ///< as camera_pose gives it
  double lens_radius_m = 0, focus_distance_m = 0;
  /// Absent in lines of an older dsbuild. The line has "model_to_world", "model_box" ([least, most]), and
  /// what follows from them: "box_m" (the same in the world), "model_to_camera" for "opencv" and "opengl".
  std::optional<ModelPose> pose{};
  double tone_map_scale = 1;  ///< the factor used (autolinear's differs from image to image)
  std::uint64_t rejected_samples = 0;
  /// Estimated RMS error of the linear picture's luminance over its mean, from the picture's own
  /// samples; null in the file where one sample a pixel tells nothing of it.
  std::optional<double> relative_error{};
  FilmFacts film{};  ///< "film": samples taken, samples refused by kind, the error's 95 % interval
  /// An object of the counts that were made; with those of mask and amodal mask the line has
  /// "visible_fraction" too, their quotient, and "occlusion", what it lacks of 1; null where that of the
  /// amodal mask is 0. With the mask's it has "box": [x, y, width, height] in pixels around what is seen of
  /// the model, from its first column and row; null where nothing is. "truncation" is beyond / whole of
  /// count_beyond, 0 where beyond is; null where both are 0.
  PixelCounts pixel_counts{};           ///< without those of `objects`, which have their own
  std::vector<ObjectRecord> objects{};  ///< distractors, by id; not there where there are none
  Hash128 render_key, files_key;
  std::array<Hash128, 5> parts{};  ///< model, material, environment, camera, engine
};

/// How a plane of each image is stored and what its numbers are.
struct PlaneRecord {
  std::string encoding;  ///< "png8", "png16", "half", "exr"
  std::string convention;
};

struct DatasetRecord {
  std::string name, licence;
  /// "about": of description, creator, url, published (YYYY-MM-DD), version, cite those that the recipe
  /// gives. Not there where it gives none.
  std::map<std::string, std::string> about{};
  std::string recipe_text;  ///< canonical_recipe(): no path of this machine
  std::string dsbuild_version;
  std::uint64_t seed = 0;
  std::vector<std::string> class_paths;  ///< a class's id is its index
  /// Further classifications: their classes, sorted. Not there where there are none.
  std::map<std::string, std::vector<std::string>> hierarchies{};
  std::vector<std::pair<std::string, std::uint64_t>> counts;  ///< "images", "models", "train", ...
  std::vector<LicenceRecord> licences;  ///< found beside the assets, as group_licences gives them
  /// Likewise, as group_sources gives them. Not there where there are none.
  std::vector<SourceRecord> sources{};
  /// By key, of the images listed. Not there where the recipe has no distribution.
  DrawSummaries draws{};
  /// By name, of the files beside the picture. Not there where there are none.
  std::vector<std::pair<std::string, PlaneRecord>> planes{};
  /// Model -> shape_of its mesh, of all models that have one; not there where none has.
  std::map<std::string, std::string> shapes{};
  /// Model -> names of the materials that its file gives faces, the one of id n at n - 1; of models that are
  /// shown in these. Not there where none is.
  std::map<std::string, std::vector<std::string>> own_materials{};
  /// Model -> what its file held that no mesh can, and how often, by MeshReport's names. Only
  /// models that were mended; "mended_models" is not there where none was.
  std::vector<std::pair<std::string, MendedDamage>> mended_models{};
  /// All kinds, whether there are any or not, as an object of name -> {"count", "of", "examples"}.
  /// Empty where an older dsbuild wrote none.
  std::vector<Concern> concerns{};
};

/// Throws Error(asset) for a path that no manifest may hold: one that is absolute or leaves the folder,
/// or has a control character or backslash (checksums.xxh128 has one line a path, and `xxhsum -c`
/// reads no escapes).
void check_manifest_path(std::string_view path);

/// The lines of a checksum file, "<32 hex digits>  <path>", by path. Throws Error(io) where it cannot be
/// read, Error(asset) for a line that is none.
std::map<std::string, Hash128> read_checksum_file(const std::filesystem::path& file);

/// The line without its line break. Numbers must be finite and texts UTF-8: Error(asset) otherwise.
std::string to_json_line(const ImageRecord& image);
/// Throws Error(asset) with file:line and the field for what is no such line.
ImageRecord image_from_json_line(const std::string& line, const std::string& file, int line_number);

std::string to_json(const DatasetRecord& dataset);
DatasetRecord dataset_from_json(const std::string& text, const std::string& file);

/// Writes the three files, each atomically, the checksums last. Throws Error(io), and Error(asset)
/// where two images have one id, two files one path, or a path is absolute, leaves the folder or
/// holds a control character or backslash.
void write_manifest(const std::filesystem::path& folder, const DatasetRecord& dataset,
                    const std::vector<ImageRecord>& images);
/// Throws Error(asset) where it is missing or damaged, all findings with file:line.
std::vector<ImageRecord> read_images_manifest(const std::filesystem::path& folder);
DatasetRecord read_dataset_manifest(const std::filesystem::path& folder);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest_writer.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_images = "manifest/images.jsonl";
constexpr const char* k_dataset = "manifest/dataset.json";
constexpr const char* k_checksums = "manifest/checksums.xxh128";

/// Whether the file has these bytes; not where that cannot be told.
bool has_content(const fs::path& file, Hash128 content) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  try {
    return content_hash(file) == content;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void check_manifest_path(std::string_view path) {
  const fs::path parts(path);
  const bool leaves =
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part == ".."; });
  const bool odd = std::any_of(path.begin(), path.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\';
  });
  if (path.empty() || parts.is_absolute() || leaves || odd) {
    fail(ErrorKind::asset,
         "a dataset's path must be relative, stay in its folder and hold no control character or "
         "backslash, got {:?}",
         path);
  }
}

std::map<std::string, Hash128> read_checksum_file(const fs::path& file) {
  std::map<std::string, Hash128> sums;
  std::istringstream lines(read_text_file(file));
  for (std::string line; std::getline(lines, line);) {
    const std::optional<Hash128> hash = Hash128::from_hex(line.substr(0, 32));
    if (!hash || line.compare(32, 2, "  ") != 0)
      fail(ErrorKind::asset, "a line is no checksum: {}", line);
    sums.emplace(line.substr(34), *hash);
  }
  return sums;
}

ManifestWriter::ManifestWriter(const fs::path& folder)
    : folder_(folder), images_(folder / k_images) {}

void ManifestWriter::add(std::string_view line, const LineGlance& image) {
  if (any_ && image.id <= last_id_)
    fail(ErrorKind::asset, "image {} stands twice or behind {}", image.id, last_id_);
  any_ = true;
  last_id_ = image.id;
  for (const LineGlance::File& file : image.files) {
    check_manifest_path(file.path);
    checksums_.emplace_back(file.path, file.xxh128);
  }
  for (const std::string_view text : {line, std::string_view("\n")}) {
    images_.write(text);
    hash_.add(text);
  }
}

void ManifestWriter::finish(const DatasetRecord& dataset) {
  const Hash128 images = hash_.hash();
  const std::string description = to_json(dataset);
  checksums_.emplace_back(k_images, images);
  checksums_.emplace_back(k_dataset, hash_text(description));
  std::sort(checksums_.begin(), checksums_.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto twice =
      std::adjacent_find(checksums_.begin(), checksums_.end(),
                         [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != checksums_.end())
    fail(ErrorKind::asset, "the file {} belongs to two images", twice->first);
  if (!has_content(folder_ / k_images, images)) images_.commit();
  write_file_atomic(folder_ / k_dataset, description);
  FileWriter sums(folder_ / k_checksums);
  for (const auto& [path, hash] : checksums_) {
    sums.write(hash.hex());
    sums.write("  ");
    sums.write(path);
    sums.write("\n");
  }
  sums.commit();
}

void write_manifest(const fs::path& folder, const DatasetRecord& dataset,
                    const std::vector<ImageRecord>& images) {
  std::vector<const ImageRecord*> by_id;
  by_id.reserve(images.size());
  for (const ImageRecord& image : images)
    by_id.push_back(&image);
  std::sort(by_id.begin(), by_id.end(),
            [](const ImageRecord* a, const ImageRecord* b) { return a->id < b->id; });
  ManifestWriter writer(folder);
  for (const ImageRecord* image : by_id)
    writer.add(to_json_line(*image), glance_at(*image));
  writer.finish(dataset);
}

}  // namespace ds

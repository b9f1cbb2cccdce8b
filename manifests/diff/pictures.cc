// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/pictures.h"

#include "manifests/export/export_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"

namespace ds {
namespace {

namespace fs = std::filesystem;

DecodedImage decoded(const std::string& bytes, const fs::path& file) {
  return decode_image_bytes(bytes_of(bytes), file.string(), Halves::widen);
}

FileComparison compare(const DecodedImage& a, const DecodedImage& b,
                       std::vector<std::byte>* picture) {
  FileComparison found{std::nullopt, why_not_comparable(a, b)};
  if (!found.why_not.empty()) return found;
  found.pixels = pixel_difference(a, b);
  if (picture != nullptr) *picture = encode_png(difference_picture(a, b, found.pixels->largest));
  return found;
}

}  // namespace

FileComparison compare_files(const fs::path& a, const fs::path& b,
                             std::vector<std::byte>* picture) {
  return compare(decoded(read_image_file(a), a), decoded(read_image_file(b), b), picture);
}

FileComparison compare_files(const fs::path& folder_a, const fs::path& folder_b,
                             const ChangedFile& file, std::vector<std::byte>* picture) {
  DS_ASSERT(file.a && file.b);
  const auto read = [](const fs::path& folder, const FileRecord& record) {
    return decoded(read_checked(folder, record), folder / record.path);
  };
  return compare(read(folder_a, *file.a), read(folder_b, *file.b), picture);
}

}  // namespace ds

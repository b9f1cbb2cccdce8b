// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/exporter.h"

#include "manifests/export/exporter_list.h"
#include "tracer/base/error.h"
#include "tracer/render/image_files.h"

#include <algorithm>

namespace ds {

#define DS_DECLARE_EXPORTER(NAME) ExporterType NAME##_exporter();
DS_ALL_EXPORTERS(DS_DECLARE_EXPORTER)

std::span<const ExporterType> exporter_types() {
#define DS_EXPORTER_ROW(NAME) NAME##_exporter(),
  static const std::vector<ExporterType> types = {DS_ALL_EXPORTERS(DS_EXPORTER_ROW)};
  return types;
}

const ExporterType* find_exporter(std::string_view name) {
  const auto types = exporter_types();
  const auto at = std::find_if(types.begin(), types.end(),
                               [&](const ExporterType& type) { return type.name == name; });
  return at == types.end() ? nullptr : &*at;
}

bool ExportInput::has(const std::string& kind) const {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

int ExportInput::label_of(const std::string& class_path) const {
  if (!has_classes) return 0;
  if (of_hierarchy) return -1;
  const auto at = std::find(classes.begin(), classes.end(), class_path);
  return at == classes.end() ? -1 : static_cast<int>(at - classes.begin());
}

const FileRecord& file_of(const ExportImage& image, std::string_view kind) {
  const auto& files = image.record.files;
  const auto at = std::find_if(files.begin(), files.end(),
                               [&](const FileRecord& file) { return file.kind == kind; });
  DS_ASSERT(at != files.end());
  return *at;
}

const std::array<double, 9>& intrinsics_for(const char* format, const ImageRecord& record) {
  if (!record.intrinsics)
    fail(ErrorKind::asset, "{}: {} has no camera of parallel rays, got one that is {}", record.id,
         format, record.camera_model);
  return *record.intrinsics;
}

std::string ending_of(const FileRecord& file) {
  return std::filesystem::path(file.path).extension().string();
}

MaskPixels read_mask(const ExportInput& input, const ExportImage& image, std::string_view kind) {
  const FileRecord& file = file_of(image, kind);
  const std::string bytes = read_checked(input.folder, file);
  const DecodedImage decoded =
      decode_image_bytes(bytes_of(bytes), (input.folder / file.path).string(), Halves::keep);
  if (decoded.channels != 1 || decoded.type != SampleType::uint8)
    fail(ErrorKind::asset, "{}: wanted a mask of one channel of 8 bits, found {} of {}",
         (input.folder / file.path).string(), decoded.channels, sample_type_name(decoded.type));
  MaskPixels mask{decoded.width, decoded.height, std::vector<std::uint8_t>(decoded.samples.size())};
  std::transform(decoded.samples.begin(), decoded.samples.end(), mask.values.begin(),
                 [](std::byte value) { return std::to_integer<std::uint8_t>(value); });
  return mask;
}

std::optional<std::array<int, 4>> tight_box(const MaskPixels& mask) {
  int left = mask.width, right = -1, top = mask.height, bottom = -1;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (mask.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                      static_cast<std::size_t>(x)] == 0)
        continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = y;
    }
  if (right < 0) return std::nullopt;
  return std::array{left, top, right - left + 1, bottom - top + 1};
}

}  // namespace ds

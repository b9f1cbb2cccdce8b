// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/shown_objects.h"

#include "tracer/base/error.h"
#include "tracer/render/image_files.h"

#include <algorithm>
#include <cstring>

namespace ds {
namespace {

template <typename Sample>
std::vector<std::uint32_t> words_of(const DecodedImage& image) {
  std::vector<Sample> samples(image.samples.size() / sizeof(Sample));
  std::memcpy(samples.data(), image.samples.data(), samples.size() * sizeof(Sample));
  return {samples.begin(), samples.end()};
}

}  // namespace

std::vector<std::uint32_t> read_ids(const ExportInput& input, const ExportImage& image) {
  if (!input.has("object_id"))
    fail(ErrorKind::asset,
         "{}: it shows distractors, and nothing tells which pixels are whose; build with "
         "\"object_id\" in outputs.planes",
         image.record.id);
  const FileRecord& file = file_of(image, "object_id");
  const std::string name = (input.folder / file.path).string();
  const std::string bytes = read_checked(input.folder, file);
  const DecodedImage decoded = decode_image_bytes(bytes_of(bytes), name, Halves::keep);
  const bool is_of_ids = decoded.channels == 1 &&
                         (decoded.type == SampleType::uint8 || decoded.type == SampleType::uint16);
  if (!is_of_ids)
    fail(ErrorKind::asset, "{}: wanted ids of one channel of 8 or 16 bits, found {} of {}", name,
         decoded.channels, sample_type_name(decoded.type));
  return decoded.type == SampleType::uint8 ? words_of<std::uint8_t>(decoded)
                                           : words_of<std::uint16_t>(decoded);
}

MaskPixels mask_of_id(const std::vector<std::uint32_t>& ids, std::uint32_t id, int width,
                      int height) {
  MaskPixels mask{width, height, std::vector<std::uint8_t>(ids.size())};
  std::transform(ids.begin(), ids.end(), mask.values.begin(), [&](std::uint32_t pixel) {
    return pixel == id ? std::uint8_t{255} : std::uint8_t{0};
  });
  return mask;
}

std::vector<ListedObject> shown_objects(const ExportInput& input, const ExportImage& image) {
  std::vector<ListedObject> objects;
  objects.push_back({nullptr, image.label, read_mask(input, image)});
  if (image.record.objects.empty()) return objects;
  const std::vector<std::uint32_t> ids = read_ids(input, image);
  for (const ObjectRecord& object : image.record.objects)
    objects.push_back({&object, input.label_of(object.class_path),
                       mask_of_id(ids, object.id, image.record.width, image.record.height)});
  return objects;
}

}  // namespace ds

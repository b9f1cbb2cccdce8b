// SPDX-License-Identifier: Apache-2.0
#include "builder/make/plane_outputs.h"

#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

const Plane* find(const std::vector<Plane>& planes, const PlaneType& type) {
  const auto found = std::find_if(planes.begin(), planes.end(),
                                  [&](const Plane& plane) { return plane.type == &type; });
  return found == planes.end() ? nullptr : &*found;
}

std::vector<std::uint8_t> covered(const Plane& plane) {
  std::vector<std::uint8_t> samples;
  samples.reserve(plane.values.size());
  for (const float value : plane.values)
    samples.push_back(value > 0 ? 255 : 0);
  return samples;
}

}  // namespace

std::vector<const PlaneType*> planes_of(const OutputSettings& outputs) {
  OutputSettings all = outputs;
  const PlaneType& mask = plane_type("mask");
  if (all.find_plane("mask") == nullptr) all.set_plane({&mask, encodings_of(mask).front()});
  std::vector<const PlaneType*> types;
  for (const PlaneOutput& plane : all.planes)
    if (!is_of_light(*plane.type)) types.push_back(plane.type);
  return types;
}

std::vector<const PlaneType*> wanted_light_planes(const OutputSettings& outputs) {
  std::vector<const PlaneType*> types;
  for (const PlaneOutput& plane : outputs.planes)
    if (is_of_light(*plane.type)) types.push_back(plane.type);
  const PlaneType& alpha = plane_type("alpha");
  const bool cuts =
      std::any_of(outputs.planes.begin(), outputs.planes.end(),
                  [](const PlaneOutput& plane) { return plane.encoding == PlaneEncoding::rgba8; });
  if (cuts && outputs.find_plane(alpha.name) == nullptr) types.push_back(&alpha);
  return types;
}

bool is_cut_out(const OutputSettings& outputs, const OutputFile& output) {
  const PlaneOutput* wanted = outputs.find_plane(output.kind);
  return wanted != nullptr && wanted->encoding == PlaneEncoding::rgba8;
}

PixelCounts count_planes(const std::vector<Plane>& planes, const PlaneType& of) {
  PixelCounts counts;
  const Plane* mask = find(planes, plane_type("mask"));
  if (mask != nullptr && !is_of_model_alone(of))
    add_counts(counts, count_mask(covered(*mask), mask->width, mask->height));
  if (const Plane* alone = find(planes, plane_type("amodal_mask")))
    add_counts(counts, count_amodal_mask(covered(*alone), alone->width, alone->height));
  return counts;
}

std::vector<std::byte> encode_output(const OutputSettings& outputs, const OutputFile& output,
                                     const std::vector<Plane>& planes) {
  const Plane* plane = find(planes, *output.plane);
  const PlaneOutput* wanted = outputs.find_plane(output.kind);
  DS_ASSERT(plane != nullptr && wanted != nullptr);
  return encode_plane(*plane, wanted->encoding);
}

std::vector<std::byte> encode_cut_out(const OutputFile& output, const std::vector<Plane>& planes,
                                      const Film& film, const ToneMap& tone_map) {
  const Plane* foreground = find(planes, *output.plane);
  const Plane* alpha = find(planes, plane_type("alpha"));
  DS_ASSERT(foreground != nullptr && alpha != nullptr);
  return encode_png(cut_out(*foreground, *alpha, tone_map, tone_map_scale(film, tone_map)));
}

}  // namespace ds

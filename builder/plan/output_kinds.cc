// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/output_kinds.h"

#include "tracer/base/canonical.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/sdl.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ds {
namespace {

constexpr std::string_view k_picture_ending = ".png";

bool reads_ids(const PlaneType& plane) {
  return (plane.traits & (kernels::k_plane_objects | kernels::k_plane_material_ids)) != 0;
}

std::string plane_ending(const PlaneType& type, PlaneEncoding encoding) {
  return fmt::format(".{}{}", type.name, ending_of(encoding));
}

/// The lines of a canonical text that tell ids.
std::string lines_of_ids(std::string_view text) {
  std::string ids;
  for (std::size_t end = 0; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1))
    if (const auto line = text.substr(0, end + 1); line.find(".id ") != line.npos) ids += line;
  return ids;
}

}  // namespace

std::vector<OutputKind> kinds_of(const OutputSettings& outputs) {
  std::vector<OutputKind> kinds;
  if (outputs.image) kinds.push_back({"image", std::string(k_picture_ending), k_picture_format});
  for (const PlaneOutput& plane : outputs.planes)
    kinds.push_back({plane.type->name, plane_ending(*plane.type, plane.encoding),
                     format_of(plane.encoding), plane.type,
                     plane.encoding == PlaneEncoding::rgba8});
  return kinds;
}

std::string output_path(const std::string& image_id, std::string_view ending) {
  constexpr std::string_view k_folder = "images/";
  std::string path;
  path.reserve(k_folder.size() + image_id.size() + ending.size());
  ((path += k_folder) += image_id) += ending;
  return path;
}

std::vector<std::string> output_paths(const OutputSettings& outputs, const std::string& image_id) {
  std::vector<std::string> paths;
  for (const OutputKind& kind : kinds_of(outputs))
    paths.push_back(output_path(image_id, kind.ending));
  return paths;
}

const std::vector<std::string>& all_output_endings() {
  static const std::vector<std::string> endings = [] {
    std::vector<std::string> list{std::string(k_picture_ending)};
    for (const PlaneType& type : plane_types())
      for (const PlaneEncoding encoding : encodings_of(type))
        if (std::string ending = plane_ending(type, encoding); ending != list.back())
          list.push_back(std::move(ending));
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }();
  return endings;
}

std::string canonical_files(const OutputSettings& outputs, const ToneMap& tone_map,
                            const EnvironmentFacts& environment) {
  CanonicalText text;
  std::string ids;
  for (const OutputKind& kind : kinds_of(outputs)) {
    text.add(kind.kind, kind.format);
    if (kind.plane != nullptr && reads_ids(*kind.plane))
      ids += lines_of_ids(environment.shapes.at(plane_reads(*kind.plane)));
  }
  return text.text() + canonical_tone_map(tone_map) + ids;
}

}  // namespace ds

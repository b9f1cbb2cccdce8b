// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a line of images.jsonl says that tells whether it still holds: what can be seen without
/// taking the line apart, which costs fifty times as much. Views into the line or the record.
struct LineGlance {
  struct File {
    std::string_view path, kind;
    Hash128 xxh128;
  };
  std::string_view id, model, class_path, split, material, environment;
  std::vector<File> files;
  std::uint64_t pixels = 0;  ///< width times height
  PixelCounts pixel_counts;
  std::optional<std::uint64_t> class_id, fold;
  std::string other_classes;  ///< as canonical JSON; "" where there are none
  std::string draws;          ///< draws_text
  Hash128 render_key, files_key;
};

/// Of a line that `to_json_line` wrote, without its line break. Nothing where a text in it is
/// escaped, or where it is another line: `image_from_json_line` then tells.
std::optional<LineGlance> glance_at(std::string_view line);
LineGlance glance_at(const ImageRecord& image);
/// The line's files, whole. Nothing where glance_at gives nothing.
std::optional<std::vector<FileRecord>> files_at_glance(std::string_view line);
/// Of each line of manifest/images.jsonl, which holds until `visit` returns. Throws as
/// read_images_manifest, of the first line that is wrong where a glance shows it.
void visit_glances(const std::filesystem::path& folder,
                   const std::function<void(const LineGlance& line)>& visit);
/// ImageRecord::other_classes as LineGlance has them.
std::string other_classes_text(const std::map<std::string, std::string>& classes);
/// The draws as canonical JSON, and before them how often they were drawn.
std::string draws_text(std::optional<std::uint64_t> attempts, const DrawRecords& draws);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/manifest_lines.h"

#include "manifests/manifest_glance.h"
#include "tracer/base/error.h"
#include "tracer/base/regular_file.h"

#include <utility>

namespace ds {

ManifestLines::ManifestLines(std::filesystem::path folder)
    : folder_(std::move(folder)),
      file_(folder_ / "manifest/images.jsonl"),
      in_(regular_stream(file_)) {
  next();
}

void ManifestLines::next() {
  const bool is_line = static_cast<bool>(std::getline(in_, text_));
  // A line without its break is cut off, and all else that ends a file early is told there too.
  if (is_line == in_.eof() || in_.bad()) read_images_manifest(folder_);
  at_end_ = !is_line;
  if (at_end_) return;
  ++number_;
  std::string id = id_of_line();
  if (number_ > 1 && id <= id_)
    fail(ErrorKind::asset, "{}:{}: ids must ascend, found {} behind {}", file_.string(), number_,
         id, id_);
  id_ = std::move(id);
}

std::string ManifestLines::id_of_line() const {
  if (const auto glance = glance_at(text_)) return std::string(glance->id);
  return record().id;
}

ImageRecord ManifestLines::record() const {
  return image_from_json_line(text_, file_.string(), number_);
}

}  // namespace ds

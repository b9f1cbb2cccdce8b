// SPDX-License-Identifier: Apache-2.0
#include "builder/make/older_lines.h"

#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/regular_file.h"

#include <algorithm>
#include <utility>

namespace ds {
namespace {

std::vector<ImageRecord> read_whole(const std::filesystem::path& folder) {
  try {
    std::vector<ImageRecord> records = read_images_manifest(folder);
    std::stable_sort(records.begin(), records.end(),
                     [](const ImageRecord& a, const ImageRecord& b) { return a.id < b.id; });
    const auto same_id = [](const ImageRecord& a, const ImageRecord& b) { return a.id == b.id; };
    records.erase(std::unique(records.begin(), records.end(), same_id), records.end());
    return records;
  } catch (const Error& damaged) {
    warn(fmt::format("{}; images that are not made anew are left out of the new one",
                     damaged.what()));
    return {};
  }
}

}  // namespace

OlderLine::OlderLine(ImageRecord record) : text(to_json_line(record)), record_(std::move(record)) {
  glance = glance_at(*record_);
}

ImageRecord OlderLine::record() const {
  return record_ ? *record_ : image_from_json_line(text, "manifest/images.jsonl", 0);
}

OlderLines::OlderLines(const std::filesystem::path& folder, bool as_written) {
  if (folder.empty()) return;
  file_ = folder / "manifest/images.jsonl";
  std::error_code error;
  if (!std::filesystem::exists(file_, error)) return;
  if (!as_written) {
    records_ = read_whole(folder);
    return;
  }
  in_ = regular_stream(file_);
  if (!in_) fail(ErrorKind::io, "{}: cannot be read", file_.string());
}

const OlderLine* OlderLines::next_read() {
  if (next_ == records_.size()) return nullptr;
  line_ = OlderLine(std::move(records_[next_++]));
  line_.glance = glance_at(*line_.record_);
  return &line_;
}

const OlderLine* OlderLines::next() {
  if (!in_.is_open()) return next_read();
  line_.record_.reset();
  if (!std::getline(in_, line_.text)) {
    if (in_.bad()) fail(ErrorKind::io, "{}: cannot be read", file_.string());
    return nullptr;
  }
  if (const auto glance = glance_at(line_.text)) {
    line_.glance = *glance;
  } else {
    line_.record_ = image_from_json_line(line_.text, file_.string(), 0);
    line_.glance = glance_at(*line_.record_);
  }
  return &line_;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest_glance.h"

#include "manifests/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

namespace ds {
namespace {

/// Goes through a line from key to key, each as it stands there: `"key":`, which is part of no text,
/// whose quotes are escaped. The keys of an object are sorted, so one pass finds all.
class Cursor {
 public:
  explicit Cursor(std::string_view line) : rest_(line) {}

  bool ok() const { return ok_; }

  std::string_view text(std::string_view key) {
    find(key);
    const std::size_t end = starts('"') ? rest_.find('"', 1) : rest_.npos;
    if (end == rest_.npos) return fail();
    const std::string_view value = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return value.find('\\') == value.npos ? value : fail();
  }

  Hash128 hash(std::string_view key) {
    const std::optional<Hash128> value = Hash128::from_hex(text(key));
    if (!value) fail();
    return value.value_or(Hash128{});
  }

  std::uint64_t count(std::string_view key) {
    find(key);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) {
      fail();
      return 0;
    }
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  /// What stands behind a key from its bracket to the next `close`.
  Cursor inside(std::string_view key, char open, std::string_view close) {
    find(key);
    const std::size_t end = starts(open) ? rest_.find(close) : rest_.npos;
    if (end == rest_.npos) return Cursor(fail());
    const Cursor inner(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return inner;
  }

  bool has(std::string_view key) const { return rest_.find(key) != rest_.npos; }
  /// Whether null stands behind the key.
  bool is_null(std::string_view key) const {
    const std::size_t found = rest_.find(key);
    return found == rest_.npos || rest_.substr(found + key.size()).starts_with("null");
  }
  /// Whether the text comes next.
  bool follows(std::string_view text) const { return rest_.starts_with(text); }
  /// What comes before the text.
  std::string_view until(std::string_view text) {
    const std::size_t end = rest_.find(text);
    if (end == rest_.npos) return fail();
    const std::string_view value = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return value;
  }

 private:
  std::string_view fail() {
    ok_ = false;
    rest_ = {};
    return {};
  }
  bool starts(char c) const { return !rest_.empty() && rest_.front() == c; }

  void find(std::string_view key) {
    const std::size_t at = rest_.find(key);
    if (at == rest_.npos)
      fail();
    else
      rest_.remove_prefix(at + key.size());
  }

  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace

std::optional<LineGlance> glance_at(std::string_view line) {
  LineGlance glance;
  Cursor at(line);
  if (!at.is_null(R"("class_id":)")) glance.class_id = at.count(R"("class_id":)");
  glance.class_path = at.text(R"("class_path":)");
  // A quote inside a text has a backslash before it, so these stand between members only.
  constexpr std::string_view k_classes = R"(,"classes":)", k_draws = R"(,"draws":)",
                             k_attempts = R"(,"draw_attempts":)";
  std::string_view between = at.until(R"(,"environment":)");
  const std::size_t draws =
      std::min({between.find(k_attempts), between.find(k_draws), between.size()});
  if (between.starts_with(k_classes))
    glance.other_classes = between.substr(k_classes.size(), draws - k_classes.size());
  between.remove_prefix(draws);
  if (between.starts_with(k_attempts)) {
    between.remove_prefix(k_attempts.size());
    glance.draws = std::string(between.substr(0, between.find(k_draws))) + " ";
    between.remove_prefix(std::min(between.find(k_draws), between.size()));
  }
  if (!between.empty()) glance.draws += between.substr(k_draws.size());
  glance.environment = at.text(R"("environment":)");
  Cursor files = at.inside(R"("files":)", '[', R"(],"files_key":)");
  while (files.ok() && files.has(R"("kind":)")) {
    LineGlance::File& file = glance.files.emplace_back();
    file.kind = files.text(R"("kind":)");
    file.path = files.text(R"("path":)");
    file.xxh128 = files.hash(R"("xxh128":)");
  }
  glance.files_key = at.hash(R"("files_key":)");
  if (at.has(R"("fold":)")) glance.fold = at.count(R"("fold":)");
  const std::uint64_t height = at.count(R"("height":)");
  glance.id = at.text(R"("id":)");
  glance.material = at.text(R"("material":)");
  glance.model = at.text(R"("model":)");
  Cursor counts = at.inside(R"("pixel_counts":)", '{', "}");
  const auto count = [&](std::string_view key, std::optional<std::uint64_t>& to) {
    if (counts.has(key)) to = counts.count(key);
  };
  count(R"("above":)", glance.pixel_counts.above);
  count(R"("amodal":)", glance.pixel_counts.amodal);
  count(R"("below":)", glance.pixel_counts.below);
  count(R"("beyond":)", glance.pixel_counts.beyond);
  count(R"("frame":)", glance.pixel_counts.frame);
  count(R"("left":)", glance.pixel_counts.left);
  count(R"("lit":)", glance.pixel_counts.lit);
  count(R"("model":)", glance.pixel_counts.model);
  count(R"("right":)", glance.pixel_counts.right);
  count(R"("white":)", glance.pixel_counts.white);
  count(R"("whole":)", glance.pixel_counts.whole);
  glance.render_key = at.hash(R"("render_key":)");
  glance.split = at.text(R"("split":)");
  glance.pixels = height * at.count(R"("width":)");
  if (!at.ok() || !files.ok() || !counts.ok()) return std::nullopt;
  return glance;
}

std::optional<std::vector<FileRecord>> files_at_glance(std::string_view line) {
  constexpr std::size_t k_sha256_digits = 64;
  std::vector<FileRecord> all;
  Cursor at(line);
  Cursor files = at.inside(R"("files":)", '[', R"(],"files_key":)");
  // One that lacks a member is not to take the next file's.
  bool follow = true;
  const auto next = [&](std::string_view key) {
    follow = follow && files.follows(key);
    return key;
  };
  while (files.ok() && files.has(R"("kind":)")) {
    FileRecord& file = all.emplace_back();
    file.kind = files.text(R"("kind":)");
    file.path = files.text(next(R"(,"path":)"));
    file.pixels = files.hash(next(R"(,"pixels_xxh128":)"));
    file.hashes.sha256 = files.text(next(R"(,"sha256":)"));
    file.hashes.size_bytes = files.count(next(R"(,"size_bytes":)"));
    file.hashes.xxh128 = files.hash(next(R"(,"xxh128":)"));
    if (!follow || file.hashes.sha256.size() != k_sha256_digits) return std::nullopt;
  }
  at.text(R"("id":)");
  if (!at.ok() || !files.ok()) return std::nullopt;
  return all;
}

std::string draws_text(std::optional<std::uint64_t> attempts, const DrawRecords& draws) {
  return (attempts ? fmt::format("{} ", *attempts) : "") +
         (draws.empty() ? "" : canonical_json(to_json_value(draws)));
}

std::string other_classes_text(const std::map<std::string, std::string>& classes) {
  return classes.empty() ? "" : canonical_json(classes);
}

void visit_glances(const std::filesystem::path& folder,
                   const std::function<void(const LineGlance& line)>& visit) {
  const std::filesystem::path file = folder / "manifest/images.jsonl";
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    // The last line's break is part of it: without it the file is cut off.
    const auto glance = in.eof() ? std::nullopt : glance_at(line);
    if (glance)
      visit(*glance);
    else if (!in.eof())
      visit(glance_at(image_from_json_line(line, file.string(), number)));
    else
      break;
  }
  // Not there, not readable, or cut off: that is told there.
  if (!in.eof() || !line.empty()) read_images_manifest(folder);
}

LineGlance glance_at(const ImageRecord& image) {
  LineGlance glance{
      image.id,
      image.model,
      image.class_path,
      image.split,
      image.material,
      image.environment,
      {},
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height),
      image.pixel_counts,
      image.class_id,
      image.fold,
      other_classes_text(image.other_classes),
      draws_text(image.draw_attempts, image.draws),
      image.render_key,
      image.files_key};
  for (const FileRecord& file : image.files)
    glance.files.push_back({file.path, file.kind, file.hashes.xxh128});
  return glance;
}

}  // namespace ds

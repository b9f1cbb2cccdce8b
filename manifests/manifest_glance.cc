// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest_glance.h"

#include <charconv>

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
    if (error != std::errc()) fail();
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
  glance.class_path = at.text(R"("class_path":)");
  glance.environment = at.text(R"("environment":)");
  Cursor files = at.inside(R"("files":)", '[', R"(],"files_key":)");
  while (files.ok() && files.has(R"("kind":)")) {
    LineGlance::File& file = glance.files.emplace_back();
    file.kind = files.text(R"("kind":)");
    file.path = files.text(R"("path":)");
    file.xxh128 = files.hash(R"("xxh128":)");
  }
  glance.files_key = at.hash(R"("files_key":)");
  const std::uint64_t height = at.count(R"("height":)");
  glance.id = at.text(R"("id":)");
  glance.material = at.text(R"("material":)");
  glance.model = at.text(R"("model":)");
  Cursor counts = at.inside(R"("pixel_counts":)", '{', "}");
  const auto count = [&](std::string_view key, std::optional<std::uint64_t>& to) {
    if (counts.has(key)) to = counts.count(key);
  };
  count(R"("amodal":)", glance.pixel_counts.amodal);
  count(R"("frame":)", glance.pixel_counts.frame);
  count(R"("lit":)", glance.pixel_counts.lit);
  count(R"("model":)", glance.pixel_counts.model);
  count(R"("white":)", glance.pixel_counts.white);
  glance.render_key = at.hash(R"("render_key":)");
  glance.split = at.text(R"("split":)");
  glance.pixels = height * at.count(R"("width":)");
  if (!at.ok() || !files.ok() || !counts.ok()) return std::nullopt;
  return glance;
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
      image.render_key,
      image.files_key};
  for (const FileRecord& file : image.files)
    glance.files.push_back({file.path, file.kind, file.hashes.xxh128});
  return glance;
}

}  // namespace ds

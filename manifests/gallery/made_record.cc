// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/made_record.h"

#include "manifests/whole_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <charconv>
#include <optional>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_head = "dsbuild gallery 1";

/// What stands before the next `end`, and takes it off.
std::string_view take(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

std::optional<std::vector<double>> facts_from(std::string_view text) {
  std::vector<double> facts;
  if (text == "-") return facts;
  while (!text.empty()) {
    const std::string_view part = take(text, ',');
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size()) return std::nullopt;
    facts.push_back(value);
  }
  return facts;
}

}  // namespace

MadeRecord::MadeRecord(const fs::path& folder) {
  std::string all;
  try {
    if (!is_whole_folder(folder, k_gallery_folder)) return;
    all = read_text_file(folder / k_gallery_folder.record);
  } catch (const Error&) {  // then all is made anew
    return;
  }
  std::string_view text = all;
  if (take(text, '\n') != k_head) return;
  while (!text.empty()) {
    std::string_view line = take(text, '\n');
    const std::string_view use = take(line, ' ');
    const auto source = Hash128::from_hex(take(line, ' '));
    const std::string_view hash = take(line, ' '), path = take(line, ' ');
    const auto own = hash == "-" ? Hash128{} : Hash128::from_hex(hash);
    auto facts = facts_from(line);
    if (!source || !own || !facts) continue;
    add(use, *source, {*own, path == "-" ? "" : std::string(path), std::move(*facts)});
  }
}

const MadeRecord::Row* MadeRecord::find(std::string_view use, Hash128 source) const {
  const auto at = rows_.find(std::pair{std::string(use), source});
  return at == rows_.end() ? nullptr : &at->second;
}

void MadeRecord::add(std::string_view use, Hash128 source, Row&& row) {
  rows_.try_emplace(std::pair{std::string(use), source}, std::move(row));
}

std::string MadeRecord::text() const {
  std::string text = std::string(k_head) + "\n";
  for (const auto& [key, row] : rows_)
    text += fmt::format("{} {} {} {} {}\n", key.first, key.second.hex(),
                        row.path.empty() ? "-" : row.hash.hex(), row.path.empty() ? "-" : row.path,
                        row.facts.empty() ? "-" : fmt::format("{}", fmt::join(row.facts, ",")));
  return text;
}

}  // namespace ds

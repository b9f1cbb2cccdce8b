// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/datasets.h"

#include "manifests/json_text.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

constexpr std::array k_parts{"model", "material", "environment", "camera", "engine"};

/// Keys, files and parts are compared by themselves; what is counted in a picture follows from it.
bool is_of_files(const std::string& field) {
  static const std::set<std::string, std::less<>> names{
      "box",          "files", "files_key",      "film",
      "occlusion",    "parts", "relative_error", "rejected_samples",
      "pixel_counts", "id",    "render_key",     "visible_fraction",
      "truncation"};
  return names.contains(field);
}

/// Names of fields of two objects that are not in both with one value.
std::vector<std::string> differing_fields(const json& a, const json& b,
                                          bool (*leave_out)(const std::string&)) {
  std::set<std::string> names;
  for (const auto& [x, y] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const auto& [name, value] : x->items())
      if (const auto at = y->find(name); at == y->end() || *at != value) names.insert(name);
  std::erase_if(names, leave_out);
  return {names.begin(), names.end()};
}

std::vector<ChangedFile> changed_files(const ImageRecord& a, const ImageRecord& b) {
  std::map<std::string_view, ChangedFile> by_kind;
  for (const FileRecord& file : a.files)
    by_kind[file.kind].a = &file;
  for (const FileRecord& file : b.files)
    by_kind[file.kind].b = &file;
  std::vector<ChangedFile> changed;
  for (const auto& [kind, files] : by_kind)
    if (files.a == nullptr || files.b == nullptr ||
        files.a->hashes.xxh128 != files.b->hashes.xxh128)
      changed.push_back(files);
  return changed;
}

ChangedImage compare(const ImageRecord& a, const ImageRecord& b) {
  ChangedImage found{&a, &b, {}, {}, changed_files(a, b)};
  for (std::size_t i = 0; i < k_parts.size(); ++i)
    if (a.parts[i] != b.parts[i]) found.parts.emplace_back(k_parts[i]);
  const std::string line_a = to_json_line(a), line_b = to_json_line(b);
  if (line_a != line_b)
    found.fields = differing_fields(json::parse(line_a), json::parse(line_b), is_of_files);
  return found;
}

}  // namespace

DatasetDifference compare_datasets(const DatasetRecord& a, const std::vector<ImageRecord>& images_a,
                                   const DatasetRecord& b,
                                   const std::vector<ImageRecord>& images_b) {
  DatasetDifference found;
  auto x = images_a.begin();
  auto y = images_b.begin();
  while (x != images_a.end() || y != images_b.end()) {
    if (y == images_b.end() || (x != images_a.end() && x->id < y->id)) {
      found.only_a.push_back(&*x++);
    } else if (x == images_a.end() || y->id < x->id) {
      found.only_b.push_back(&*y++);
    } else {
      ChangedImage image = compare(*x++, *y++);
      if (image.parts.empty() && image.fields.empty() && image.files.empty())
        ++found.same;
      else
        found.changed.push_back(std::move(image));
    }
  }
  found.dataset_fields = differing_fields(
      json::parse(to_json(a)), json::parse(to_json(b)),
      [](const std::string& name) { return name == "concerns" || name == "counts"; });
  return found;
}

}  // namespace ds

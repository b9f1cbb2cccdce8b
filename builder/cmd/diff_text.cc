// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/diff_text.h"

#include "tracer/base/streams.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

constexpr std::size_t k_most_named = 5;

/// Fields that a part of the key does not tell.
constexpr std::array<std::string_view, 7> k_labels{
    "class_path", "class_id", "classes", "environment", "material", "split", "view"};

std::string names_of(const std::vector<std::string>& names, bool all) {
  const std::size_t shown = all ? names.size() : std::min(names.size(), k_most_named);
  std::string text = fmt::format(
      "{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// What an image differs in: parts of its key and labels, else what is left.
std::string cause_of(const ChangedImage& image) {
  std::vector<std::string> words = image.parts;
  for (const std::string& field : image.fields)
    if (image.parts.empty() || std::find(k_labels.begin(), k_labels.end(), field) != k_labels.end())
      if (std::find(words.begin(), words.end(), field) == words.end()) words.push_back(field);
  if (words.empty()) return "files alone";
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string file_text(const ChangedFile& file, const FileComparison& found) {
  if (!file.a) return "in B alone";
  if (!file.b) return "in A alone";
  if (file.is_same_picture()) return "same pixels in other bytes";
  return difference_text(found);
}

/// Of a kind of file within a group, the one whose pixels are furthest apart.
struct Worst {
  std::size_t files = 0;
  double rms = -1;
  std::string text, path;
};

void note(std::map<std::string, Worst>& by_kind, const ChangedFile& file,
          const FileComparison& found) {
  Worst& worst = by_kind[file.either().kind];
  ++worst.files;
  const double rms = found.pixels ? found.pixels->rms : 0;
  if (rms <= worst.rms) return;
  worst.rms = rms;
  worst.text = file_text(file, found);
  worst.path = file.either().path;
}

}  // namespace

std::string difference_text(const FileComparison& found) {
  if (!found.pixels) return found.why_not;
  const PixelDifference& d = *found.pixels;
  if (d.pixels == 0) return "same pixels in other bytes";
  std::string text = fmt::format("{} of {} pixels, largest {:.4g} at {}, {}, RMS {:.4g}", d.pixels,
                                 d.of, d.largest, d.x, d.y, d.rms);
  if (d.not_finite > 0) text += fmt::format(", {} not finite in one alone", d.not_finite);
  return text;
}

json difference_json(const FileComparison& found) {
  if (!found.pixels) return {{"why_not", found.why_not}};
  const PixelDifference& d = *found.pixels;
  return {{"pixels", d.pixels},   {"of", d.of}, {"not_finite", d.not_finite},
          {"largest", d.largest}, {"x", d.x},   {"y", d.y},
          {"rms", d.rms}};
}

void print_difference(const DatasetDifference& found,
                      const std::vector<FileComparisons>& comparisons, bool verbose) {
  for (const auto& [images, where] :
       {std::pair(&found.only_a, 'A'), std::pair(&found.only_b, 'B')}) {
    if (images->empty()) continue;
    say(Stream::result, "in {} alone: {}: {}\n", where, images->size(), names_of(*images, verbose));
  }
  std::map<std::string, std::vector<std::size_t>> by_cause;
  for (std::size_t i = 0; i < found.changed.size(); ++i)
    by_cause[cause_of(found.changed[i])].push_back(i);
  for (const auto& [cause, members] : by_cause) {
    std::vector<std::string> names;
    std::map<std::string, Worst> by_kind;
    for (const std::size_t i : members) {
      names.push_back(found.changed[i].id);
      for (std::size_t f = 0; f < comparisons[i].size(); ++f)
        note(by_kind, found.changed[i].files[f], comparisons[i][f]);
    }
    say(Stream::result, "differ in {}: {}: {}\n", cause, names.size(), names_of(names, false));
    if (verbose) {
      for (const std::size_t i : members)
        for (std::size_t f = 0; f < comparisons[i].size(); ++f)
          say(Stream::result, "  {}: {}\n", found.changed[i].files[f].either().path,
              file_text(found.changed[i].files[f], comparisons[i][f]));
    } else {
      for (const auto& [kind, worst] : by_kind)
        say(Stream::result, "  {}: {} file{}{}: {}: {}\n", kind, worst.files,
            worst.files == 1 ? "" : "s", worst.files == 1 ? "" : ", the worst", worst.path,
            worst.text);
    }
  }
  if (!found.dataset_fields.empty())
    say(Stream::result, "manifest/dataset.json differs in {}\n",
        fmt::format("{}", fmt::join(found.dataset_fields, ", ")));
  say(Stream::result, "{} images are the same, {} differ, {} are in A alone, {} in B alone\n",
      found.same, found.changed.size(), found.only_a.size(), found.only_b.size());
}

json difference_json(const DatasetDifference& found,
                     const std::vector<FileComparisons>& comparisons) {
  json changed = json::array();
  for (std::size_t i = 0; i < found.changed.size(); ++i) {
    const ChangedImage& image = found.changed[i];
    json files = json::array();
    for (std::size_t f = 0; f < image.files.size(); ++f) {
      const ChangedFile& file = image.files[f];
      json row{{"path", file.either().path}, {"kind", file.either().kind}};
      if (!file.a || !file.b)
        row["only"] = file.a ? "A" : "B";
      else if (file.is_same_picture())
        row["same_pixels"] = true;
      else
        row.update(difference_json(comparisons[i][f]));
      files.push_back(std::move(row));
    }
    changed.push_back({{"id", image.id},
                       {"parts", image.parts},
                       {"fields", image.fields},
                       {"files", std::move(files)}});
  }
  return {{"same", found.same},
          {"only_a", found.only_a},
          {"only_b", found.only_b},
          {"changed", std::move(changed)},
          {"dataset_fields", found.dataset_fields}};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// Pictures that look alike though their pixels are not equal, and what differs between them.
#include "manifests/check/check.h"
#include "manifests/check/divisions.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace ds {
namespace {

constexpr Threshold k_distance{"near_duplicates_distance",
                               0.01,
                               {.least = 0, .most = 1},
                               "How far the means of 16x16 parts of two pictures may be apart "
                               "(RMS, of 1) for them to look alike"};

/// Bits of PictureFacts::gradient that may differ: of four equal parts of it one is then the same.
constexpr int k_most_bits = 3;

std::uint64_t part_of(std::uint64_t gradient, unsigned part) {
  return (gradient >> (16 * part) & 0xffffU) | std::uint64_t{part} << 16;
}

/// The lowest 16 bits of four that are none.
unsigned first_equal_part(std::uint64_t bits) {
  unsigned part = 0;
  while (part < 3 && (bits >> (16 * part) & 0xffffU) != 0)
    ++part;
  return part;
}

bool same_pixels(const ImageRecord& a, const ImageRecord& b) {
  const auto pixels = [](const ImageRecord& image) {
    const auto at = std::find_if(image.files.begin(), image.files.end(),
                                 [](const FileRecord& file) { return file.kind == "image"; });
    return at == image.files.end() ? Hash128{} : at->pixels;
  };
  return pixels(a) == pixels(b);
}

/// "camera", "model and material", ...: what is not the same of two images.
std::string what_differs(const ImageRecord& a, const ImageRecord& b) {
  std::vector<std::string> parts;
  if (a.model != b.model) parts.emplace_back("model");
  if (a.material != b.material) parts.emplace_back("material");
  if (a.environment != b.environment) parts.emplace_back("environment");
  if (a.camera_to_world != b.camera_to_world || a.intrinsics != b.intrinsics)
    parts.emplace_back("camera");
  return parts.empty() ? "seed or settings" : fmt::format("{}", fmt::join(parts, " and "));
}

void check_near_duplicates(const CheckInput& input, CheckReport& report) {
  const double distance = input.threshold(k_distance);
  std::vector<std::pair<std::uint64_t, std::size_t>> parts;
  std::uint64_t pictures = 0;
  for (std::size_t i = 0; i < input.files.pictures.size(); ++i) {
    if (!input.files.pictures[i]) continue;
    ++pictures;
    for (unsigned part = 0; part < 4; ++part)
      parts.emplace_back(part_of(input.files.pictures[i]->gradient, part), i);
  }
  std::sort(parts.begin(), parts.end());
  // Of each picture the first found that it is like, by what divides the two.
  using Others = std::map<std::size_t, std::size_t>;
  std::map<std::string_view, Others> found;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size() && parts[j].first == parts[i].first; ++j) {
      const std::size_t a = parts[i].second, b = parts[j].second;
      const PictureFacts &facts_a = *input.files.pictures[a], &facts_b = *input.files.pictures[b];
      const std::uint64_t bits = facts_a.gradient ^ facts_b.gradient;
      if (std::popcount(bits) > k_most_bits || first_equal_part(bits) != parts[i].first >> 16)
        continue;  // the other equal parts bring the pair again
      Others& others = found[divided_by(input.images[a], input.images[b])];
      if (!others.contains(b) && are_alike(facts_a, facts_b, distance) &&
          !same_pixels(input.images[a], input.images[b]))
        others.emplace(b, a);
    }
  const auto add = [&](const Others& others, CheckLevel level, std::string what,
                       const char* advice) {
    std::vector<std::string> names;
    std::set<std::string> ids;
    for (const auto& [i, other_i] : others) {
      const ImageRecord &image = input.images[i], &other = input.images[other_i];
      names.push_back(
          fmt::format("{} as {} (another {})", image.id, other.id, what_differs(image, other)));
      ids.insert({image.id, other.id});
    }
    report.add(level, std::move(what), names, pictures, advice,
               std::vector<std::string>(ids.begin(), ids.end()));
  };
  for (const std::string_view division : {"split", "fold"})
    add(found[division], CheckLevel::warning,
        fmt::format("pictures look like one in another {}", division),
        "what is tested was nearly seen in training");
  add(found[""], CheckLevel::note, "pictures look like another", "");
}

}  // namespace

Check near_duplicates_check() {
  return {"near_duplicates", "pictures that look alike", check_near_duplicates, {k_distance}, true};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/check/picture_facts.h"
#include "manifests/manifest.h"
#include "tracer/base/number_range.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

enum class CheckLevel {
  note,     ///< worth knowing, and often meant
  warning,  ///< hardly what is wanted
  error,    ///< the dataset misleads who trains or tests with it
};
std::string_view name_of(CheckLevel level);

/// What a check found: `count` of `of` things, the first few of them by name.
struct CheckFinding {
  std::string check;
  CheckLevel level = CheckLevel::note;
  std::string what;  ///< "images whose mask is empty"
  std::uint64_t count = 0, of = 0;
  std::vector<std::string> examples{};
  std::string advice{};  ///< what mends it; may be empty
  /// Ids of all images it is about, ordered as the manifest; none where it is about the dataset.
  std::vector<std::string> images{};
};
inline constexpr std::size_t k_check_examples = 3;
/// An object of all but the images.
nlohmann::json to_json_value(const CheckFinding& finding);

/// A number of a check that a recipe may set: the key check.NAME.
struct Threshold {
  std::string_view name;  ///< begins with the check's
  double standard;        ///< without such a key
  NumberRange range;
  std::string_view help;  ///< as those of recipe keys
};

/// A dataset as its manifest tells it, and its pictures where they were read.
struct CheckInput {
  DatasetRecord dataset;
  std::vector<ImageRecord> images;  ///< ordered by id
  /// Of each of the images (read_file_facts); empty where no file was read.
  FileFacts files{};
  /// Settings of the recipe as it is now, of which the thresholds are taken; without it those are the
  /// manifest's, too.
  std::optional<std::string> recipe_now{};

  /// As the recipe sets it.
  double threshold(const Threshold& threshold) const;
  /// "random" of "materials.assign = random"; "" where the recipe in the manifest has no such key.
  std::string setting(std::string_view key) const;
};

/// Collects what one check finds.
class CheckReport {
 public:
  explicit CheckReport(std::string check) : check_(std::move(check)) {}

  /// Things that were looked at one by one, of which `found` are concerned; nothing where none is.
  /// `images`: ids of the images that have to do with it, where `found` are no ids.
  void add(CheckLevel level, std::string what, const std::vector<std::string>& found,
           std::uint64_t of, std::string advice = "",
           std::optional<std::vector<std::string>> images = std::nullopt);
  /// Something about the dataset as a whole.
  void say(CheckLevel level, std::string what, std::string advice = "");

  std::vector<CheckFinding> take() && { return std::move(findings_); }

 private:
  std::string check_;
  std::vector<CheckFinding> findings_;
};

/// A check of `dsbuild check`: NAME.cc and its line in CMakeLists.txt.
struct Check {
  const char* name;
  const char* help;  ///< one line
  void (*run)(const CheckInput& input, CheckReport& report);
  std::vector<Threshold> thresholds{};
  bool reads_pictures = false;  ///< runs only where CheckInput::files are there
};

/// In alphabetical order.
std::span<const Check> checks();

/// Whether one of those named reads pictures.
bool any_reads_pictures(const std::vector<std::string>& names);

/// Runs all that can be with what is there, or those named. Error(usage) for a name that is none.
std::vector<CheckFinding> run_checks(const CheckInput& input,
                                     const std::vector<std::string>& names);

/// Errors, warnings, notes; else in the order they have.
std::vector<CheckFinding> worst_first(std::vector<CheckFinding> findings);

/// "mug.ply/3" of those images for which `is` holds.
template <typename Is>
std::vector<std::string> ids_where(const std::vector<ImageRecord>& images, const Is& is) {
  std::vector<std::string> ids;
  for (const ImageRecord& image : images)
    if (is(image)) ids.push_back(image.id);
  return ids;
}

}  // namespace ds

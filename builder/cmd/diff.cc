// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/diff_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "manifests/json_text.h"
#include "manifests/whole_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/file_names.h"
#include "tracer/base/hash.h"
#include "tracer/base/parallel.h"
#include "tracer/base/streams.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <span>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// -o: pictures of differences, or nowhere. Any thread may put one there.
class Pictures {
 public:
  explicit Pictures(const std::string& folder) {
    if (!folder.empty()) to_.emplace(checked_place(folder, k_diff_folder), k_diff_folder);
  }
  bool wanted() const { return to_.has_value(); }
  /// `path`: of the file compared, or its name.
  void put(const std::string& path, std::span<const std::byte> png) {
    const std::lock_guard lock(mutex_);
    to_->write(fs::path(path).replace_extension(".png").generic_string(), png);
  }
  void commit(const nlohmann::json& record) {
    if (!to_) return;
    const std::string text = canonical_json(record, 2);
    to_->write(k_diff_folder.record, std::as_bytes(std::span(text)));
    to_->commit();
  }

 private:
  std::optional<WholeFolder> to_;
  std::mutex mutex_;
};

bool is_image_file(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && !has_ending(path, ".toml");
}

int diff_of_files(const Arguments& arguments) {
  Pictures pictures(arguments.diff_folder);
  std::vector<std::byte> png;
  const FileComparison found =
      compare_files(arguments.target, arguments.other, pictures.wanted() ? &png : nullptr);
  if (!png.empty()) pictures.put(fs::path(arguments.target).filename().string(), png);
  const nlohmann::json record = difference_json(found);
  pictures.commit(record);
  const bool same = found.pixels && found.pixels->pixels == 0;
  if (arguments.json)
    print_json(record);
  else
    say(Stream::result, "{}\n", same ? "the same pixels" : difference_text(found));
  return same ? 0 : 1;
}

std::vector<FileComparisons> compare_pictures(const DatasetDifference& found, const fs::path& a,
                                              const fs::path& b, Pictures& pictures) {
  std::vector<FileComparisons> comparisons(found.changed.size());
  const std::atomic<bool>& stop = stop_on_signal();
  WorkProgress progress("images compared");
  std::mutex mutex;
  std::uint64_t done = 0;
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !stop; ++i) {
      for (const ChangedFile& file : found.changed[i].files) {
        FileComparison& comparison = comparisons[i].emplace_back();
        if (!file.a || !file.b || file.is_same_picture()) continue;
        std::vector<std::byte> png;
        comparison = compare_files(a, b, file, pictures.wanted() ? &png : nullptr);
        if (!png.empty()) pictures.put(file.a->path, png);
      }
      const std::lock_guard lock(mutex);
      progress(++done, found.changed.size());
    }
  };
  parallel_ranges(found.changed.size(), 1, work);
  if (stop) fail(ErrorKind::cancelled, "stopped");
  return comparisons;
}

void check_there(const char* which, const std::string& target) {
  std::error_code error;
  if (!fs::exists(target, error))
    fail(ErrorKind::usage,
         "diff: wanted {}, a recipe, the folder of a dataset or an image file, found nothing at {}",
         which, target);
}

/// The folder of a dataset that a word names, which is made.
fs::path made_dataset(const char* which, const std::string& target) {
  std::error_code error;
  fs::path folder = dataset_folder({target, {}, {}, {}, false});
  if (!fs::is_directory(target, error) && !fs::exists(folder / "manifest", error))
    fail(ErrorKind::usage,
         "diff: wanted {}, a dataset that is made, found the recipe {}, of which nothing is built "
         "in {} (name its folder, or dsbuild build it)",
         which, target, folder.string());
  return folder;
}

}  // namespace

int run_diff(const Arguments& arguments) {
  const bool a_is_file = is_image_file(arguments.target),
             b_is_file = is_image_file(arguments.other);
  if (a_is_file && b_is_file) return diff_of_files(arguments);
  check_there("A", arguments.target);
  check_there("B", arguments.other);
  if (a_is_file || b_is_file)
    fail(ErrorKind::usage, "diff: wanted two datasets or two image files, found {} and {}",
         arguments.target, arguments.other);
  const fs::path a = made_dataset("A", arguments.target), b = made_dataset("B", arguments.other);
  for (const fs::path& dataset : {a, b})
    if (!arguments.diff_folder.empty()) check_outside(arguments.diff_folder, dataset);
  Pictures pictures(arguments.diff_folder);
  const DatasetDifference found = compare_datasets(a, b);
  const std::vector<FileComparisons> comparisons = compare_pictures(found, a, b, pictures);
  const nlohmann::json record = difference_json(found, comparisons);
  pictures.commit(record);
  if (arguments.json)
    print_json(record);
  else
    print_difference(found, comparisons, arguments.verbose);
  return found.images_differ() ? 1 : 0;
}

}  // namespace ds

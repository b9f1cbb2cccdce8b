// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/made_files.h"

#include "manifests/export/exporter.h"
#include "manifests/gallery/previews.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr int k_thumbnail_pixels = 128, k_preview_pixels = 256, k_jpeg_quality = 80;
/// Images made before their files are written: what waits in memory.
constexpr std::size_t k_images_at_once = 512;
constexpr std::string_view k_thumbnail = "thumbnail", k_box = "box";

/// Something that is made of a file of the dataset.
struct Task {
  std::size_t image;
  std::string use;
  const FileRecord* source;
  std::string path;  ///< of the file to write; empty: facts alone
};

struct Done {
  std::vector<std::byte> file;
  std::vector<double> facts;
  bool reused = false, broken = false;
};

/// Four digits, so that records are short and read back as they were.
double four_digits(double share) {
  return std::round(share * 1e4) / 1e4;
}

DecodedImage decode(const fs::path& dataset, const FileRecord& file) {
  const std::string bytes = read_checked(dataset, file);
  return decode_image_bytes(bytes_of(bytes), (dataset / file.path).string(), Halves::widen);
}

Done make(const fs::path& dataset, const Task& task) {
  const BytePicture picture = preview_of(decode(dataset, *task.source), task.source->kind);
  Done done;
  if (task.use == k_box) {
    if (picture.channels != 1) return done;
    if (const auto box = tight_box({picture.width, picture.height, picture.pixels}))
      done.facts.assign(box->begin(), box->end());
    return done;
  }
  if (task.use == k_thumbnail) {
    const Brightness brightness = brightness_of(picture);
    done.facts = {four_digits(brightness.mean), four_digits(brightness.deviation)};
    done.file = encode_jpeg(scaled_down(picture, k_thumbnail_pixels), k_jpeg_quality);
  } else {
    done.file = encode_jpeg(scaled_down(picture, k_preview_pixels), k_jpeg_quality);
  }
  return done;
}

/// As it was made before, where that is still there.
std::optional<Done> reuse(const MadeRecord& before, const fs::path& gallery, const Task& task) {
  const MadeRecord::Row* const row = before.find(task.use, task.source->hashes.xxh128);
  if (row == nullptr || row->path.empty() != task.path.empty()) return std::nullopt;
  Done done{{}, row->facts, true, false};
  if (task.path.empty()) return done;
  try {
    check_manifest_path(row->path);
    const std::string bytes = read_text_file(gallery / row->path);
    if (hash_text(bytes) != row->hash) return std::nullopt;
    const auto span = bytes_of(bytes);
    done.file.assign(span.begin(), span.end());
    return done;
  } catch (const Error&) {  // gone: it is made anew
    return std::nullopt;
  }
}

/// Browsers show these as they are.
bool is_shown_by_browsers(const FileRecord& file) {
  return file.path.ends_with(".png") &&
         (file.kind == "image" || file.kind == "mask" || file.kind == "amodal_mask");
}

/// As the manifest has it; nothing where an older dsbuild wrote that.
std::optional<std::array<int, 4>> counted_box(const ImageRecord& image) {
  const PixelCounts& counts = image.pixel_counts;
  if (!counts.left || !counts.right || !counts.above || !counts.below || counts.model == 0U)
    return std::nullopt;
  const int left = static_cast<int>(*counts.left), above = static_cast<int>(*counts.above);
  return std::array{left, above, image.width - left - static_cast<int>(*counts.right),
                    image.height - above - static_cast<int>(*counts.below)};
}

std::vector<Task> tasks_of(std::size_t index, const ImageRecord& image) {
  std::vector<Task> tasks;
  if (image.files.empty()) return tasks;
  const std::string stem = gallery_file_stem(index);
  const auto picture = std::find_if(image.files.begin(), image.files.end(),
                                    [](const FileRecord& file) { return file.kind == "image"; });
  const FileRecord& shown = picture == image.files.end() ? image.files.front() : *picture;
  tasks.push_back({index, std::string(k_thumbnail), &shown, "t/" + stem + ".jpg"});
  for (const FileRecord& file : image.files) {
    if (file.kind == "mask" && !image.pixel_counts.left)
      tasks.push_back({index, std::string(k_box), &file, ""});
    if (!is_shown_by_browsers(file))
      tasks.push_back({index, file.kind, &file, fmt::format("p/{}.{}.jpg", stem, file.kind)});
  }
  return tasks;
}

class Maker {
 public:
  Maker(const fs::path& dataset, std::size_t images, WholeFolder& to)
      : dataset_(dataset), to_(to), before_(to.replaces() ? MadeRecord(to.place()) : MadeRecord()) {
    result_.extras.resize(images);
    result_.previews.resize(images);
  }

  void run(const std::vector<Task>& tasks) {
    std::vector<Done> done(tasks.size());
    parallel_ranges(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        done[i] = one(tasks[i]);
    });
    for (std::size_t i = 0; i < tasks.size(); ++i)
      keep(tasks[i], done[i]);
  }

  void set_box(std::size_t image, const std::optional<std::array<int, 4>>& box) {
    result_.extras[image].box = box;
  }

  MadeFiles take() && { return std::move(result_); }

 private:
  Done one(const Task& task) const {
    if (auto kept = reuse(before_, to_.place(), task)) return std::move(*kept);
    try {
      return make(dataset_, task);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::asset) throw;
      Done broken;
      broken.broken = true;
      return broken;
    }
  }

  void keep(const Task& task, const Done& done) {
    if (done.broken) {
      auto& broken = result_.broken;
      if (broken.empty() || broken.back() != task.image) broken.push_back(task.image);
      return;
    }
    ImageExtras& extras = result_.extras[task.image];
    if (task.use == k_thumbnail && done.facts.size() == 2) {
      extras.brightness = done.facts[0];
      extras.contrast = done.facts[1];
    } else if (task.use == k_box && done.facts.size() == 4) {
      extras.box.emplace();
      std::transform(done.facts.begin(), done.facts.end(), extras.box->begin(),
                     [](double value) { return static_cast<int>(value); });
    }
    MadeRecord::Row row{{}, task.path, done.facts};
    if (!task.path.empty()) {
      row.hash = hash_bytes(done.file);
      to_.write(task.path, done.file);
      result_.bytes += done.file.size();
      ++(done.reused ? result_.reused : result_.made);
      if (task.use != k_thumbnail) result_.previews[task.image].push_back(task.use);
    }
    result_.record.add(task.use, task.source->hashes.xxh128, std::move(row));
  }

  const fs::path& dataset_;
  WholeFolder& to_;
  MadeRecord before_;
  MadeFiles result_;
};

}  // namespace

std::string gallery_file_stem(std::size_t image) {
  return fmt::format("{:02}/{:05}", image / 1000, image);
}

MadeFiles make_gallery_files(const fs::path& dataset, const std::vector<ImageRecord>& images,
                             WholeFolder& to, const std::function<void(std::uint64_t)>& done) {
  Maker maker(dataset, images.size(), to);
  for (std::size_t begin = 0; begin < images.size(); begin += k_images_at_once) {
    const std::size_t end = std::min(begin + k_images_at_once, images.size());
    std::vector<Task> tasks;
    for (std::size_t i = begin; i < end; ++i) {
      maker.set_box(i, counted_box(images[i]));
      for (Task& task : tasks_of(i, images[i]))
        tasks.push_back(std::move(task));
    }
    maker.run(tasks);
    done(end);
  }
  return std::move(maker).take();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/made_files.h"

#include "manifests/export/exporter.h"
#include "manifests/gallery/previews.h"
#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

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
  enum class State { lacking, found, made, broken };
  State state = State::lacking;
  std::vector<std::byte> file;  ///< of one that was made
  MadeRecord::Row row;          ///< its path: of the file that was found
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
  done.state = Done::State::made;
  if (task.use == k_box) {
    if (picture.channels != 1) return done;
    if (const auto box = tight_box({picture.width, picture.height, picture.pixels}))
      done.row.facts.assign(box->begin(), box->end());
    return done;
  }
  if (task.use == k_thumbnail) {
    const Brightness brightness = brightness_of(picture);
    done.row.facts = {four_digits(brightness.mean), four_digits(brightness.deviation)};
  }
  const int longest = task.use == k_thumbnail ? k_thumbnail_pixels : k_preview_pixels;
  done.file = encode_jpeg(scaled_down(picture, longest), k_jpeg_quality);
  done.row.hash = hash_bytes(done.file);
  return done;
}

bool has_bytes(const fs::path& file, Hash128 hash) {
  std::error_code error;
  return fs::is_regular_file(file, error) && content_hash(file) == hash;
}

/// As it was made before, where that is still there; the bytes of its file stay where they are.
std::optional<MadeRecord::Row> find_made(const MadeRecord& before, const fs::path& gallery,
                                         const Task& task) {
  const MadeRecord::Row* const row = before.find(task.use, task.source->hashes.xxh128);
  if (row == nullptr || row->path.empty() != task.path.empty()) return std::nullopt;
  if (task.path.empty()) return *row;
  try {
    // Of images of one source the record has the first.
    MadeRecord::Row found = *row;
    check_manifest_path(found.path);
    if (has_bytes(gallery / task.path, found.hash))
      found.path = task.path;
    else if (!has_bytes(gallery / found.path, found.hash))
      return std::nullopt;
    return found;
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
  /// `gallery`: the one that stands there, if any. Without `to` nothing is made or written.
  Maker(fs::path dataset, fs::path gallery, std::size_t images, WholeFolder* to)
      : dataset_(std::move(dataset)),
        gallery_(std::move(gallery)),
        to_(to),
        before_(MadeRecord(gallery_)) {
    result_.extras.resize(images);
    result_.previews.resize(images);
  }

  /// False where something is lacking.
  bool run(const std::vector<Task>& tasks) {
    std::vector<Done> done(tasks.size());
    parallel_ranges(tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        done[i] = one(tasks[i]);
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      if (done[i].state == Done::State::lacking) return false;
      keep(tasks[i], done[i]);
    }
    return true;
  }

  void set_box(std::size_t image, const std::optional<std::array<int, 4>>& box) {
    result_.extras[image].box = box;
  }

  /// What the page shows as it is must be there, of the size that the manifest says.
  void look_for_shown(std::size_t index, const ImageRecord& image) {
    if (std::any_of(image.files.begin(), image.files.end(), [&](const FileRecord& file) {
          std::error_code error;
          return is_shown_by_browsers(file) &&
                 fs::file_size(dataset_ / file.path, error) != file.hashes.size_bytes;
        }))
      result_.broken.push_back(index);
  }

  MadeFiles take() && {
    auto& broken = result_.broken;
    std::sort(broken.begin(), broken.end());
    broken.erase(std::unique(broken.begin(), broken.end()), broken.end());
    return std::move(result_);
  }

 private:
  Done one(const Task& task) const {
    Done done;
    if (auto row = find_made(before_, gallery_, task)) {
      if (to_ == nullptr && row->path != task.path) return done;
      done.state = Done::State::found;
      done.row = std::move(*row);
      return done;
    }
    if (to_ == nullptr) return done;
    try {
      return make(dataset_, task);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::asset) throw;
      done.state = Done::State::broken;
      return done;
    }
  }

  void keep(const Task& task, Done& done) {
    if (done.state == Done::State::broken) {
      result_.broken.push_back(task.image);
      return;
    }
    ImageExtras& extras = result_.extras[task.image];
    const std::vector<double>& facts = done.row.facts;
    if (task.use == k_thumbnail && facts.size() == 2) {
      extras.brightness = facts[0];
      extras.contrast = facts[1];
    } else if (task.use == k_box && facts.size() == 4) {
      extras.box.emplace();
      std::transform(facts.begin(), facts.end(), extras.box->begin(),
                     [](double value) { return static_cast<int>(value); });
    }
    if (!task.path.empty()) keep_file(task, done);
    done.row.path = task.path;
    result_.record.add(task.use, task.source->hashes.xxh128, std::move(done.row));
  }

  void keep_file(const Task& task, const Done& done) {
    if (task.use != k_thumbnail) result_.previews[task.image].push_back(task.use);
    if (done.state == Done::State::found) {
      ++result_.reused;
      result_.bytes += fs::file_size(gallery_ / done.row.path);
      if (to_ != nullptr) to_->keep(task.path, done.row.hash, done.row.path);
    } else {
      ++result_.made;
      result_.bytes += done.file.size();
      to_->write(task.path, done.file);
    }
  }

  fs::path dataset_, gallery_;
  WholeFolder* to_;
  MadeRecord before_;
  MadeFiles result_;
};

/// Nothing where something is lacking.
std::optional<MadeFiles> run_all(Maker& maker, const std::vector<ImageRecord>& images,
                                 const std::function<void(std::uint64_t)>& done) {
  for (std::size_t begin = 0; begin < images.size(); begin += k_images_at_once) {
    const std::size_t end = std::min(begin + k_images_at_once, images.size());
    std::vector<Task> tasks;
    for (std::size_t i = begin; i < end; ++i) {
      maker.set_box(i, counted_box(images[i]));
      for (Task& task : tasks_of(i, images[i]))
        tasks.push_back(std::move(task));
      maker.look_for_shown(i, images[i]);
    }
    if (!maker.run(tasks)) return std::nullopt;
    done(end);
  }
  return std::move(maker).take();
}

}  // namespace

std::string gallery_file_stem(std::size_t image) {
  return fmt::format("{:02}/{:05}", image / 1000, image);
}

std::optional<MadeFiles> standing_gallery_files(const fs::path& dataset, const fs::path& gallery,
                                                const std::vector<ImageRecord>& images) {
  Maker maker(dataset, gallery, images.size(), nullptr);
  return run_all(maker, images, [](std::uint64_t) {});
}

MadeFiles make_gallery_files(const fs::path& dataset, const std::vector<ImageRecord>& images,
                             WholeFolder& to, const std::function<void(std::uint64_t)>& done) {
  Maker maker(dataset, to.place(), images.size(), &to);
  std::optional<MadeFiles> made = run_all(maker, images, done);
  DS_ASSERT(made.has_value());
  return std::move(*made);
}

}  // namespace ds

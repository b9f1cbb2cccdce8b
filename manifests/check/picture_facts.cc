// SPDX-License-Identifier: Apache-2.0
#include "manifests/check/picture_facts.h"

#include "manifests/image_samples.h"
#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace ds {
namespace {

/// A picture's values by pixel and channel; of grey its one for all three.
class Pixels {
 public:
  explicit Pixels(const DecodedImage& image) : image_(image), samples_(image) {}
  int width() const { return image_.width; }
  int height() const { return image_.height; }
  float at(int x, int y, int c) const {
    const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                       static_cast<std::size_t>(x);
    const int channel = image_.channels < 3 ? 0 : c;
    const double value = samples_[pixel * static_cast<std::size_t>(image_.channels) +
                                  static_cast<std::size_t>(channel)];
    return std::clamp(static_cast<float>(value), 0.0F, 1.0F);
  }
  /// Rec. 709, of developed values.
  float luma(int x, int y) const {
    return 0.2126F * at(x, y, 0) + 0.7152F * at(x, y, 1) + 0.0722F * at(x, y, 2);
  }

 private:
  const DecodedImage& image_;
  ImageSamples samples_;
};

/// Pixels [begin, end) of part `i` of `parts` of `size` pixels; at least one is in each.
std::pair<int, int> part(int i, int parts, int size) {
  const auto border = [&](int k) { return static_cast<int>(std::int64_t{k} * size / parts); };
  return {border(i), std::max(border(i + 1), border(i) + 1)};
}

/// Mean over part (i, j) of a grid of columns x rows.
template <typename Value>
double mean_of(const Pixels& pixels, int i, int columns, int j, int rows, const Value& value) {
  const auto [left, right] = part(i, columns, pixels.width());
  const auto [top, bottom] = part(j, rows, pixels.height());
  double sum = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      sum += value(x, y);
  return sum / (static_cast<double>(right - left) * (bottom - top));
}

void fill_thumbnail(const Pixels& pixels, PictureFacts& facts) {
  constexpr int k_side = PictureFacts::k_side;
  std::size_t at = 0;
  for (int j = 0; j < k_side; ++j)
    for (int i = 0; i < k_side; ++i)
      for (int c = 0; c < 3; ++c)
        facts.thumbnail[at++] = static_cast<float>(mean_of(
            pixels, i, k_side, j, k_side, [&](int x, int y) { return pixels.at(x, y, c); }));
}

std::uint64_t gradient_of(const Pixels& pixels) {
  std::uint64_t bits = 0;
  for (int j = 0; j < 8; ++j) {
    double before = 0;
    for (int i = 0; i < 9; ++i) {
      const double mean =
          mean_of(pixels, i, 9, j, 8, [&](int x, int y) { return pixels.luma(x, y); });
      if (i > 0 && mean > before) bits |= std::uint64_t{1} << (8 * j + i - 1);
      before = mean;
    }
  }
  return bits;
}

void count_specks(const Pixels& pixels, PictureFacts& facts) {
  const int width = pixels.width(), height = pixels.height();
  std::vector<float> luma(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto at = [&](int x, int y) -> float& {
    return luma[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      at(x, y) = pixels.luma(x, y);
  facts.pixels = luma.size();
  constexpr auto k_speck = static_cast<float>(PictureFacts::k_speck);
  for (int y = 2; y < height - 2; ++y)
    for (int x = 2; x < width - 2; ++x) {
      const float own = at(x, y);
      // Most are not: of a speck one of the two beside it is the third lightest or darker.
      if (own - std::min(at(x - 1, y), at(x + 1, y)) < k_speck) continue;
      std::array<float, 3> lightest{};
      for (int v = y - 2; v <= y + 2; ++v)
        for (int u = x - 2; u <= x + 2; ++u) {
          float value = at(u, v);
          for (float& one : lightest)
            if (value > one) std::swap(value, one);
        }
      facts.specks += own - lightest[2] >= k_speck ? 1U : 0U;
    }
}

/// Adds what lies two pixels before and behind each edge of the mask along (dx, dy).
void add_edges(const Pixels& picture, const Pixels& mask, int dx, int dy, double& sum,
               std::uint64_t& count) {
  const auto inside = [&](int x, int y) { return mask.at(x, y, 0) > 0; };
  for (int y = dy; y + 2 * dy < picture.height(); ++y)
    for (int x = dx; x + 2 * dx < picture.width(); ++x) {
      // before, first | second, behind: the edge runs through the middle, and is blurred there.
      const bool first = inside(x, y);
      if (inside(x - dx, y - dy) != first || inside(x + dx, y + dy) == first ||
          inside(x + 2 * dx, y + 2 * dy) == first)
        continue;
      float most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(
            most, std::abs(picture.at(x - dx, y - dy, c) - picture.at(x + 2 * dx, y + 2 * dy, c)));
      sum += most;
      ++count;
    }
}

}  // namespace

PictureFacts facts_of(const DecodedImage& picture, const DecodedImage* mask) {
  PictureFacts facts;
  const Pixels pixels(picture);
  fill_thumbnail(pixels, facts);
  facts.gradient = gradient_of(pixels);
  count_specks(pixels, facts);
  if (mask != nullptr && mask->width == picture.width && mask->height == picture.height) {
    double sum = 0;
    std::uint64_t count = 0;
    add_edges(pixels, Pixels(*mask), 1, 0, sum, count);
    add_edges(pixels, Pixels(*mask), 0, 1, sum, count);
    if (count > 0) facts.edge_contrast = sum / static_cast<double>(count);
  }
  return facts;
}

bool are_alike(const PictureFacts& a, const PictureFacts& b, double distance) {
  constexpr std::size_t k_row = std::size_t{3} * PictureFacts::k_side;
  const double most = distance * distance * static_cast<double>(a.thumbnail.size());
  double sum = 0;
  for (std::size_t row = 0; row < a.thumbnail.size(); row += k_row) {
    for (std::size_t i = row; i < row + k_row; ++i) {
      const double difference = a.thumbnail[i] - b.thumbnail[i];
      sum += difference * difference;
    }
    if (!(sum <= most)) return false;  // most pairs are told apart by their first rows; also NaN
  }
  return true;
}

namespace {

std::optional<DecodedImage> read_kind(const std::filesystem::path& folder, const ImageRecord& image,
                                      std::string_view kind) {
  for (const FileRecord& file : image.files) {
    if (file.kind != kind) continue;
    const std::filesystem::path path = folder / file.path;
    const std::string bytes = read_image_file(path);
    return decode_image_bytes(bytes_of(bytes), path.string(), Halves::widen);
  }
  return std::nullopt;
}

/// Nothing for an image without depth, mask and pose.
std::optional<DepthView> read_depths(const std::filesystem::path& folder,
                                     const ImageRecord& image) {
  if (!image.pose || (!image.intrinsics && !image.metres_per_pixel)) return std::nullopt;
  const auto depth = read_kind(folder, image, "depth");
  const auto mask = depth ? read_kind(folder, image, "mask") : std::nullopt;
  if (!mask) return std::nullopt;
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const auto is_right = [&](const DecodedImage& one) {
    return one.width == image.width && one.height == image.height;
  };
  if (!is_right(*depth) || !is_right(*mask))
    fail(ErrorKind::asset, "{}: depth and mask must be {} x {} as the manifest says", image.id,
         image.width, image.height);
  DepthView view{&image, std::vector<float>(pixels), std::vector<std::uint8_t>(pixels)};
  // Whole numbers are millimetres.
  const double unit = depth->type == SampleType::uint16 ? 65.535 : 1;
  const ImageSamples depths(*depth), seen(*mask);
  for (std::size_t i = 0; i < pixels; ++i) {
    view.depth[i] =
        static_cast<float>(depths[i * static_cast<std::size_t>(depth->channels)] * unit);
    view.mask[i] = seen[i * static_cast<std::size_t>(mask->channels)] > 0 ? 1 : 0;
  }
  return view;
}

/// Of each image the next one of the same model at the same place, round the list; itself where it is alone.
std::vector<std::size_t> other_views(const std::vector<ImageRecord>& images) {
  std::map<std::pair<std::string, std::array<double, 16>>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (images[i].pose) groups[{images[i].model, images[i].pose->model_to_world}].push_back(i);
  std::vector<std::size_t> others(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    others[i] = i;
  for (const auto& [place, group] : groups)
    for (std::size_t i = 0; i < group.size(); ++i)
      others[group[i]] = group[(i + 1) % group.size()];
  return others;
}

}  // namespace

FileFacts read_file_facts(const std::filesystem::path& folder,
                          const std::vector<ImageRecord>& images,
                          const std::function<void(const std::string& why)>& failed,
                          const std::function<void(std::uint64_t done, std::uint64_t all)>& done) {
  FileFacts facts;
  facts.pictures.resize(images.size());
  facts.depths.resize(images.size());
  const std::vector<std::size_t> others = other_views(images);
  std::mutex mutex;
  std::uint64_t finished = 0;
  const auto look = [&](std::size_t i) {
    if (const auto picture = read_kind(folder, images[i], "image")) {
      const auto mask = read_kind(folder, images[i], "mask");
      facts.pictures[i] = facts_of(*picture, mask ? &*mask : nullptr);
    }
    const auto own = read_depths(folder, images[i]);
    if (!own) return;
    std::optional<DepthView> other;
    try {
      if (others[i] != i) other = read_depths(folder, images[others[i]]);
    } catch (const Error&) {  // told where that image is looked at
    }
    facts.depths[i] = depth_facts(*own, other ? &*other : nullptr);
  };
  parallel_ranges(images.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::string why;
      try {
        look(i);
      } catch (const Error& error) {
        why = error.what();
      }
      const std::scoped_lock lock(mutex);
      if (!why.empty()) failed(why);
      done(++finished, images.size());
    }
  });
  return facts;
}

}  // namespace ds

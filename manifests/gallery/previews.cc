// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/previews.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace ds {
namespace {

enum class Look { plain, depth, direction, ids, light, range };

struct LookOfKind {
  std::string_view kind;
  Look look;
};
constexpr std::array k_looks = {
    LookOfKind{"image", Look::plain},
    LookOfKind{"mask", Look::plain},
    LookOfKind{"amodal_mask", Look::plain},
    LookOfKind{"depth", Look::depth},
    LookOfKind{"distance", Look::depth},
    LookOfKind{"geometry_normal", Look::direction},
    LookOfKind{"shading_normal", Look::direction},
    LookOfKind{"object_id", Look::ids},
    LookOfKind{"material_id", Look::ids},
    LookOfKind{"albedo", Look::light},
    LookOfKind{"emission", Look::light},
    LookOfKind{"direct_diffuse", Look::light},
    LookOfKind{"direct_glossy", Look::light},
    LookOfKind{"indirect_diffuse", Look::light},
    LookOfKind{"indirect_glossy", Look::light},
    LookOfKind{"indirect_specular", Look::light},
    LookOfKind{"alpha", Look::plain},
    LookOfKind{"foreground", Look::light},
};

Look look_of(std::string_view kind) {
  const auto* const at = std::find_if(k_looks.begin(), k_looks.end(),
                                      [&](const LookOfKind& row) { return row.kind == kind; });
  return at == k_looks.end() ? Look::range : at->look;
}

/// Pixels of `channels` numbers each: whole numbers as they are.
struct Numbers {
  int width = 0, height = 0, channels = 1;
  bool is_float = false;
  double most = 255;  ///< of whole numbers
  std::vector<float> values;
};

Numbers numbers_of(const DecodedImage& image) {
  DS_ASSERT(image.type != SampleType::half);
  Numbers numbers{image.width, image.height, image.channels, false, 255, {}};
  const std::byte* const from = image.samples.data();
  const auto read = [&]<typename T>(T) {
    numbers.values.resize(image.samples.size() / sizeof(T));
    for (std::size_t i = 0; i < numbers.values.size(); ++i) {
      T sample;
      std::memcpy(&sample, from + i * sizeof(T), sizeof(T));
      numbers.values[i] = static_cast<float>(sample);
    }
  };
  if (image.type == SampleType::uint8) {
    read(std::uint8_t{});
  } else if (image.type == SampleType::uint16) {
    numbers.most = 65535;
    read(std::uint16_t{});
  } else {
    numbers.is_float = true;
    read(float{});
  }
  return numbers;
}

std::uint8_t byte_of(double share) {
  return static_cast<std::uint8_t>(share > 0 ? std::min(share, 1.0) * 255 + 0.5 : 0.0);
}

/// 8 bits as they are; alpha over grey.
BytePicture plain(const Numbers& from) {
  const bool has_alpha = from.channels == 2 || from.channels == 4;
  const int colors = from.channels >= 3 ? 3 : 1;
  BytePicture to{from.width, from.height, colors, {}};
  const auto stride = static_cast<std::size_t>(from.channels);
  const auto shown = static_cast<std::size_t>(colors);
  const double most = from.is_float ? 1 : from.most;
  to.pixels.resize(from.values.size() / stride * shown);
  for (std::size_t pixel = 0; pixel < from.values.size() / stride; ++pixel) {
    const float* const at = &from.values[pixel * stride];
    const double alpha = has_alpha ? double{at[stride - 1]} / most : 1;
    for (std::size_t c = 0; c < shown; ++c)
      to.pixels[pixel * shown + c] = byte_of(double{at[c]} / most * alpha + 0.5 * (1 - alpha));
  }
  return to;
}

/// Least and greatest of the finite numbers that `counts` takes.
template <typename Counts>
std::array<double, 2> range_of(const Numbers& from, const Counts& counts) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const float value : from.values)
    if (std::isfinite(value) && counts(value)) {
      least = std::min(least, double{value});
      most = std::max(most, double{value});
    }
  return {least, most};
}

BytePicture depth(const Numbers& from) {
  const auto is_met = [](float value) { return value > 0; };
  const auto [near, far] = range_of(from, is_met);
  BytePicture to{from.width, from.height, 1, {}};
  const auto stride = static_cast<std::size_t>(from.channels);
  for (std::size_t i = 0; i < from.values.size(); i += stride) {
    const float value = from.values[i];
    // The farthest is dark grey, so that it differs from nothing at all.
    const double share = far > near ? (far - double{value}) / (far - near) : 1;
    to.pixels.push_back(std::isfinite(value) && is_met(value) ? byte_of(0.15 + 0.85 * share)
                                                              : std::uint8_t{0});
  }
  return to;
}

/// Three colours of every pixel from its numbers; `color` fills them.
template <typename Color>
BytePicture colored(const Numbers& from, const Color& color) {
  BytePicture to{from.width, from.height, 3, {}};
  const auto stride = static_cast<std::size_t>(from.channels);
  to.pixels.resize(from.values.size() / stride * 3);
  for (std::size_t pixel = 0; pixel * stride < from.values.size(); ++pixel)
    color(&from.values[pixel * stride], &to.pixels[pixel * 3]);
  return to;
}

float channel(const Numbers& from, const float* pixel, int c) {
  return from.channels == 1 ? pixel[0] : c < from.channels ? pixel[c] : 0.0F;
}

BytePicture direction(const Numbers& from) {
  return colored(from, [&](const float* pixel, std::uint8_t* to) {
    bool met = false;
    for (int c = 0; c < 3; ++c)
      met = met || channel(from, pixel, c) != 0;
    for (int c = 0; c < 3; ++c) {
      const double value = double{channel(from, pixel, c)};
      to[c] = !met ? std::uint8_t{0} : byte_of(from.is_float ? (value + 1) / 2 : value / from.most);
    }
  });
}

/// Far apart hues for ids that follow each other: steps of the golden angle.
BytePicture ids(const Numbers& from) {
  return colored(from, [](const float* pixel, std::uint8_t* to) {
    const double id = double{pixel[0]};
    if (!(id > 0)) return;
    double hue = id * 0.6180339887498949;
    hue -= std::floor(hue);
    for (int c = 0; c < 3; ++c) {
      const double turn = hue + c / 3.0;
      const double side = std::abs((turn - std::floor(turn)) * 6 - 3) - 1;
      to[c] = byte_of(0.25 + 0.7 * std::clamp(side, 0.0, 1.0));
    }
  });
}

BytePicture light(const Numbers& from) {
  std::vector<float> sorted;
  for (const float value : from.values)
    if (std::isfinite(value) && value > 0) sorted.push_back(value);
  double white = 1;
  if (!sorted.empty()) {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 99 / 100);
    std::nth_element(sorted.begin(), at, sorted.end());
    white = double{*at};
  }
  if (!from.is_float) white = from.most;
  return colored(from, [&](const float* pixel, std::uint8_t* to) {
    for (int c = 0; c < 3; ++c)
      to[c] = byte_of(std::sqrt(std::max(0.0, double{channel(from, pixel, c)} / white)));
  });
}

BytePicture range(const Numbers& from) {
  const auto ends = range_of(from, [](float) { return true; });
  const double least = ends[0], most = ends[1];  // clang 14: a lambda captures no binding
  return colored(from, [&](const float* pixel, std::uint8_t* to) {
    for (int c = 0; c < 3; ++c)
      to[c] =
          byte_of(most > least ? (double{channel(from, pixel, c)} - least) / (most - least) : 0);
  });
}

}  // namespace

BytePicture preview_of(const DecodedImage& image, std::string_view kind) {
  const Numbers numbers = numbers_of(image);
  switch (look_of(kind)) {
    case Look::plain:
      return plain(numbers);
    case Look::depth:
      return depth(numbers);
    case Look::direction:
      return direction(numbers);
    case Look::ids:
      return ids(numbers);
    case Look::light:
      return light(numbers);
    case Look::range:
      return range(numbers);
  }
  assertion_failed("a Look", __FILE__, __LINE__);
}

BytePicture scaled_down(const BytePicture& picture, int longest) {
  const int longer = std::max(picture.width, picture.height);
  if (longer <= longest) return picture;
  const auto side = [&](int length) {
    return std::max(1, (length * longest + longer / 2) / longer);
  };
  BytePicture to{side(picture.width), side(picture.height), picture.channels, {}};
  const auto channels = static_cast<std::size_t>(picture.channels);
  // Pixel i of n over a source of m covers [i * m, (i + 1) * m) of its m * n parts: whole numbers,
  // so that the bits are the same everywhere.
  const auto w = static_cast<std::uint64_t>(picture.width),
             nw = static_cast<std::uint64_t>(to.width);
  const auto h = static_cast<std::uint64_t>(picture.height),
             nh = static_cast<std::uint64_t>(to.height);
  std::vector<std::uint64_t> sums(channels);
  for (std::uint64_t y = 0; y < nh; ++y)
    for (std::uint64_t x = 0; x < nw; ++x) {
      std::fill(sums.begin(), sums.end(), 0U);
      for (std::uint64_t j = y * h / nh; j * nh < (y + 1) * h; ++j) {
        const std::uint64_t tall = std::min((j + 1) * nh, (y + 1) * h) - std::max(j * nh, y * h);
        for (std::uint64_t i = x * w / nw; i * nw < (x + 1) * w; ++i) {
          const std::uint64_t area =
              tall * (std::min((i + 1) * nw, (x + 1) * w) - std::max(i * nw, x * w));
          for (std::size_t c = 0; c < channels; ++c)
            sums[c] += area * picture.pixels[(j * w + i) * channels + c];
        }
      }
      for (const std::uint64_t sum : sums)
        to.pixels.push_back(static_cast<std::uint8_t>((sum + w * h / 2) / (w * h)));
    }
  return to;
}

Brightness brightness_of(const BytePicture& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  const std::size_t count = picture.pixels.size() / channels;
  if (count == 0) return {};
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const at = &picture.pixels[i * channels];
    const double luma = channels == 1 ? static_cast<double>(at[0])
                                      : 0.2126 * at[0] + 0.7152 * at[1] + 0.0722 * at[2];
    sum += luma / 255;
    squares += luma / 255 * (luma / 255);
  }
  const double mean = sum / static_cast<double>(count);
  const double variance = squares / static_cast<double>(count) - mean * mean;
  return {mean, std::sqrt(std::max(0.0, variance))};
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/image_meaning.h"

#include "tracer/base/error.h"
#include "tracer/render/exr_header.h"
#include "tracer/render/image_claims.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {
namespace {

constexpr Chromaticities k_rec709{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
/// XYZ to the cones' responses (Bradford).
constexpr ColorMatrix k_bradford{0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                 0.0367, 0.0389, -0.0685, 1.0296};

using Triple = std::array<double, 3>;

Triple times(const ColorMatrix& m, const Triple& v) {
  Triple result{};
  for (std::size_t row = 0; row < 3; ++row)
    result[row] = m[row * 3] * v[0] + m[row * 3 + 1] * v[1] + m[row * 3 + 2] * v[2];
  return result;
}

ColorMatrix times(const ColorMatrix& a, const ColorMatrix& b) {
  ColorMatrix result{};
  for (std::size_t column = 0; column < 3; ++column) {
    const Triple c = times(a, Triple{b[column], b[3 + column], b[6 + column]});
    for (std::size_t row = 0; row < 3; ++row)
      result[row * 3 + column] = c[row];
  }
  return result;
}

/// By cofactors; nothing where the determinant is 0 or not finite.
std::optional<ColorMatrix> inverse(const ColorMatrix& m) {
  const auto minor = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return m[a] * m[d] - m[b] * m[c];
  };
  const ColorMatrix cofactors{minor(4, 5, 7, 8),  -minor(1, 2, 7, 8), minor(1, 2, 4, 5),
                              -minor(3, 5, 6, 8), minor(0, 2, 6, 8),  -minor(0, 2, 3, 5),
                              minor(3, 4, 6, 7),  -minor(0, 1, 6, 7), minor(0, 1, 3, 4)};
  const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
  if (!(std::fabs(determinant) > 1e-9) || !std::isfinite(determinant)) return std::nullopt;
  ColorMatrix result{};
  for (std::size_t i = 0; i < 9; ++i)
    result[i] = cofactors[i] / determinant;
  return result;
}

Triple white_of(const Chromaticities& c) {
  return {c[6] / c[7], 1, (1 - c[6] - c[7]) / c[7]};
}

/// Linear colours to XYZ, white at Y = 1.
std::optional<ColorMatrix> to_xyz(const Chromaticities& c) {
  if (!(std::fabs(c[7]) > 1e-6)) return std::nullopt;
  ColorMatrix primaries{};
  for (std::size_t i = 0; i < 3; ++i) {
    primaries[i] = c[i * 2];
    primaries[3 + i] = c[i * 2 + 1];
    primaries[6 + i] = 1 - c[i * 2] - c[i * 2 + 1];
  }
  const std::optional<ColorMatrix> back = inverse(primaries);
  if (!back) return std::nullopt;
  const Triple scale = times(*back, white_of(c));
  for (std::size_t i = 0; i < 9; ++i)
    primaries[i] *= scale[i % 3];
  return primaries;
}

/// XYZ seen under one white to that under another.
std::optional<ColorMatrix> adaptation(const Triple& from, const Triple& to) {
  const Triple a = times(k_bradford, from), b = times(k_bradford, to);
  ColorMatrix scaled = k_bradford;
  for (std::size_t i = 0; i < 9; ++i)
    scaled[i] *= b[i / 3] / a[i / 3];
  const std::optional<ColorMatrix> back = inverse(k_bradford);
  if (!back) return std::nullopt;
  return times(*back, scaled);
}

bool is_rec709(const Chromaticities& c) {
  constexpr double k_equal = 5e-4;  // files round to three or four digits
  return std::equal(c.begin(), c.end(), k_rec709.begin(),
                    [](double a, double b) { return std::fabs(a - b) <= k_equal; });
}

void set_colors(ImageMeaning& meaning, const Chromaticities& found, const std::string& name) {
  if (is_rec709(found)) return;
  meaning.matrix = to_rec709(found);
  if (!meaning.matrix)
    fail(ErrorKind::asset, "{}: its chromaticities {} span no colours", name,
         fmt::join(found, " "));
}

/// Names without the layer that all share ("view.R" and "view.G" as "R" and "G").
std::vector<std::string> without_layer(std::vector<std::string> names) {
  const std::size_t dot = names.front().rfind('.');
  if (dot == std::string::npos) return names;
  const std::string layer = names.front().substr(0, dot + 1);
  const bool shared = std::all_of(names.begin(), names.end(), [&](const std::string& channel) {
    return channel.starts_with(layer) && channel.find('.', layer.size()) == channel.npos;
  });
  if (shared)
    for (std::string& channel : names)
      channel.erase(0, layer.size());
  return names;
}

/// What an EXR file's channels make: they are used by their names or refused.
void set_exr_channels(ImageMeaning& meaning, const DecodedImage& decoded, const std::string& name) {
  const std::vector<std::string> names = without_layer(decoded.channel_names);
  const auto has = [&](std::string_view wanted) {
    return std::find(names.begin(), names.end(), wanted) != names.end();
  };
  const bool alpha = has("A");
  std::vector<std::string> used;
  if (has("R") && has("G") && has("B"))
    used = {"R", "G", "B"};
  else if (has("Y") && !has("RY") && !has("BY"))
    used = {"Y"};
  else if (names.size() == 1 && !alpha && !has("R") && !has("G") && !has("B"))
    used = names;
  if (alpha && (!used.empty() || names.size() == 1)) used.emplace_back("A");
  // The reader puts these in front, in this order.
  const bool in_front = used.size() <= static_cast<std::size_t>(decoded.channels) &&
                        std::equal(used.begin(), used.end(), names.begin());
  if (used.empty() || !in_front)
    fail(ErrorKind::asset,
         "{}: wanted the channels R, G, B, or Y, or one of another name, with or without A, found "
         "{}{}",
         name, fmt::join(decoded.channel_names, ", "),
         has("RY") || has("BY") ? " (luminance and chroma want converting)" : "");
  meaning.color_channels = static_cast<int>(used.size()) - (alpha ? 1 : 0);
  if (names.size() > used.size())
    meaning.unused = fmt::format("{} of {} channels", names.size() - used.size(), names.size());
}

void set_exr(ImageMeaning& meaning, const ExrHeader& header, const DecodedImage& decoded,
             const std::string& name) {
  set_exr_channels(meaning, decoded, name);
  meaning.width = static_cast<int>(header.display.width());
  meaning.height = static_cast<int>(header.display.height());
  meaning.offset_x = header.data.x0 - header.display.x0;
  meaning.offset_y = header.data.y0 - header.display.y0;
  meaning.premultiplied = true;
  meaning.cube = header.environment == ExrEnvironment::cube;
  // A file of parts may begin with its depths or a matte; which part is the picture it does not say.
  const bool by_name =
      meaning.color_channels == 3 || without_layer(decoded.channel_names).front() == "Y";
  if (header.parts > 1 && !by_name)
    fail(ErrorKind::asset, "{}: wanted the channels R, G, B or Y in its first part, found {}", name,
         fmt::join(decoded.channel_names, ", "));
  const std::string first = without_layer(decoded.channel_names).front();
  if (meaning.color_channels == 1 && (first == "Z" || first == "ZBack"))
    fail(ErrorKind::asset,
         "{}: wanted colours, found the depth channel {} alone, whose distances are "
         "no light",
         name, decoded.channel_names.front());
  if (header.parts > 1)
    meaning.unused += fmt::format("{}{} of {} parts", meaning.unused.empty() ? "" : ", ",
                                  header.parts - 1, header.parts);
  if (header.chromaticities && meaning.color_channels == 3)
    set_colors(meaning, *header.chromaticities, name);
}

/// Whether a header line scales the colours: EXPOSURE and COLORCORR say what the pixels were
/// multiplied by. Renderers take the pixels as they are, so a light is as bright here as there.
bool scales_colors(std::string_view line) {
  for (const std::string_view key : {std::string_view("EXPOSURE="), std::string_view("COLORCORR=")})
    if (line.starts_with(key)) {
      const std::string values(line.substr(key.size()));
      const char* at = values.c_str();
      for (char* next = nullptr;; at = next) {
        const double value = std::strtod(at, &next);
        if (next == at) return false;
        if (value != 1) return true;
      }
    }
  return false;
}

/// Radiance's header lines, up to the empty one.
void set_hdr(ImageMeaning& meaning, std::string_view text, const std::string& name) {
  constexpr std::string_view k_primaries = "PRIMARIES=";
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line.empty() || line == "\r") return;
    if (scales_colors(line))
      meaning.unused += fmt::format("{}header lines {}", meaning.unused.empty() ? "" : ", ", line);
    if (!line.starts_with(k_primaries)) continue;
    Chromaticities found{};
    const char* at = line.data() + k_primaries.size();
    const char* const stop = line.data() + line.size();
    for (double& value : found) {
      while (at != stop && (*at == ' ' || *at == '\t'))
        ++at;
      const auto [next, error] = std::from_chars(at, stop, value);
      if (error != std::errc()) fail(ErrorKind::asset, "{}: PRIMARIES must be eight numbers", name);
      at = next;
    }
    set_colors(meaning, found, name);
  }
}

}  // namespace

std::optional<ColorMatrix> to_rec709(const Chromaticities& from) {
  const auto forward = to_xyz(from), rec709 = to_xyz(k_rec709);
  if (!forward || !rec709 || is_rec709(from)) return std::nullopt;
  const auto adapted = adaptation(white_of(from), white_of(k_rec709));
  const auto back = inverse(*rec709);
  if (!adapted || !back) return std::nullopt;
  const ColorMatrix matrix = times(*back, times(*adapted, *forward));
  const bool finite =
      std::all_of(matrix.begin(), matrix.end(), [](double x) { return std::isfinite(x); });
  return finite ? std::optional(matrix) : std::nullopt;
}

std::optional<std::size_t> ImageMeaning::stored(int x, int y) const {
  // The unturned picture is as high as the turned one is wide from orientation 5 on.
  const int w = orientation < 5 ? width : height, h = orientation < 5 ? height : width;
  int column = orientation < 5 ? x : y, row = orientation < 5 ? y : x;
  if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
    column = w - 1 - column;
  if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
    row = h - 1 - row;
  column -= offset_x;
  row -= offset_y;
  if (column < 0 || row < 0 || column >= stored_width || row >= stored_height) return std::nullopt;
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(stored_width) +
         static_cast<std::size_t>(column);
}

ImageMeaning image_meaning(std::span<const std::byte> bytes, const DecodedImage& decoded,
                           const std::string& name) {
  ImageMeaning meaning;
  meaning.width = meaning.stored_width = decoded.width;
  meaning.height = meaning.stored_height = decoded.height;
  if (is_exr(bytes)) {
    set_exr(meaning, read_exr_header(bytes, name), decoded, name);
    return meaning;
  }
  meaning.color_channels = decoded.channels - (decoded.alpha_channel >= 0 ? 1 : 0);
  meaning.premultiplied = decoded.premultiplied;
  if (meaning.color_channels == 2 || decoded.channel_names.size() > 4)
    fail(ErrorKind::asset, "{}: wanted 1 to 4 channels, grey or colour, found {}", name,
         fmt::join(decoded.channel_names, ", "));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("#?")) set_hdr(meaning, text, name);
  if (decoded.orientation >= 1 && decoded.orientation <= 8)
    meaning.orientation = decoded.orientation;
  if (meaning.orientation >= 5) std::swap(meaning.width, meaning.height);
  return meaning;
}

}  // namespace ds

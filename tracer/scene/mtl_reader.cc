// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mtl_reader.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/text_lines.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view k_blanks = " \t";
  const std::size_t first = text.find_first_not_of(k_blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(k_blanks) - first + 1);
}

/// The first word, taken off `text` with the blanks around it.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

/// Where a file's text leads that stands in `folder`.
fs::path resolved(std::string_view written, const fs::path& folder) {
  std::string text(written);
  if (text.size() > 1 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  std::replace(text.begin(), text.end(), '\\', '/');
  const bool drive = text.size() > 1 && text[1] == ':';
  fs::path path(text);
  if (!drive && !path.is_absolute()) return (folder / path).lexically_normal();
  std::error_code error;
  if (!drive && fs::is_regular_file(path, error)) return path;
  return folder / path.filename();
}

/// A number of a line, all of it.
std::optional<double> whole_number(std::string_view word) {
  const ParsedNumber parsed = parse_number(word);
  if (parsed.size == 0 || parsed.size != word.size()) return std::nullopt;
  return parsed.value;
}

/// A material under way: what its lines say.
struct Lines {
  std::string name;
  std::array<double, 3> kd{1, 1, 1};
  std::optional<std::array<double, 3>> ks;
  std::optional<double> ns, pr, pm, dissolve, transparency;
  int illum = 2;
  bool shines = false, has_alpha_map = false;
  std::map<std::string, OwnInput> maps;  ///< by disney's input

  bool is_physical() const {
    return pr || pm || maps.contains("roughness") || maps.contains("metallic");
  }
};

class MtlReader {
 public:
  MtlReader(std::string_view text, const fs::path& file, MtlDefinitions& into)
      : file_(file), cursor_(file.string(), text, 1, '#'), into_(into) {}

  void read() {
    while (cursor_.next_line())
      read_line(in_small_letters(cursor_.word()));
    finish();
  }

 private:
  void note(const char* name) { ++(lines_ ? made_.notes : into_.notes)[name]; }

  void read_line(const std::string& word) {
    if (word == "newmtl") {
      finish();
      lines_ = Lines{};
      lines_->name = cursor_.rest_of_line();
      made_ = {};
    } else if (!lines_) {
      note("unknown_lines");
    } else if (!read_numbers(word) && !read_map(word)) {
      pass_over(word);
    }
  }

  double number() {
    if (cursor_.line_done()) cursor_.fail_here("wanted a number, found the line's end");
    return cursor_.number();
  }

  std::array<double, 3> color() {
    std::array<double, 3> rgb{};
    rgb[0] = number();
    rgb[1] = cursor_.line_done() ? rgb[0] : number();
    rgb[2] = cursor_.line_done() ? rgb[1] : number();
    return rgb;
  }

  bool read_numbers(const std::string& word) {
    if (word == "kd")
      lines_->kd = color();
    else if (word == "ks")
      lines_->ks = color();
    else if (word == "ns")
      lines_->ns = number();
    else if (word == "pr")
      lines_->pr = number();
    else if (word == "pm")
      lines_->pm = number();
    else if (word == "tr")
      lines_->transparency = number();
    else if (word == "illum")
      lines_->illum = static_cast<int>(std::clamp(number(), 0.0, 10.0));
    else if (word == "d")
      read_dissolve();
    else if (word == "ke")
      read_emission();
    else
      return false;
    return true;
  }

  void read_dissolve() {
    // "-halo": clearer where it is seen head-on.
    if (!cursor_.line_done() && cursor_.rest_starts_with("-halo")) cursor_.word();
    lines_->dissolve = number();
  }

  void read_emission() {
    const auto rgb = color();
    if (rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0) lines_->shines = true;
  }

  /// What an option of a map is followed by.
  bool read_option(std::string_view option, std::string_view& rest, OwnInput& input) {
    const auto numbers = [&](double missing) {
      std::array<double, 3> values{missing, missing, missing};
      for (double& value : values) {
        std::string_view after = rest;
        const std::optional<double> number = whole_number(take_word(after));
        if (!number || after.empty()) break;  // the last word is the file
        value = *number;
        rest = after;
      }
      return values;
    };
    if (option == "-s" || option == "-o") {
      const bool scale = option == "-s";
      const auto values = numbers(scale ? 1 : 0);
      input.uv_transform[scale ? 0 : 2] = to_number(values[0]);
      input.uv_transform[scale ? 4 : 5] = to_number(values[1]);
      return true;
    }
    if (option == "-t" || option == "-mm" || option == "-bm" || option == "-boost" ||
        option == "-texres") {
      numbers(0);
      return false;
    }
    const std::string value = in_small_letters(take_word(rest));
    if (option == "-clamp") {
      input.wrap = value == "on" ? ImageWrap::clamp : ImageWrap::repeat;
      return true;
    }
    constexpr std::array k_channels{
        std::pair{"r", ImageChannel::red},          std::pair{"g", ImageChannel::green},
        std::pair{"b", ImageChannel::blue},         std::pair{"m", ImageChannel::alpha},
        std::pair{"l", ImageChannel::colored_mean}, std::pair{"z", ImageChannel::rgb}};
    const auto* const channel = std::find_if(k_channels.begin(), k_channels.end(),
                                             [&](const auto& c) { return value == c.first; });
    if (option != "-imfchan" || channel == k_channels.end()) return false;
    input.channel = channel->second;
    return true;
  }

  static float to_number(double value) {
    const float number = to_mesh_float(value);
    return std::isfinite(number) ? number : 0;
  }

  bool read_map(const std::string& word) {
    constexpr std::array k_maps{std::pair{"map_kd", "basecolor"}, std::pair{"map_pr", "roughness"},
                                std::pair{"map_pm", "metallic"}};
    const auto* const map =
        std::find_if(k_maps.begin(), k_maps.end(), [&](const auto& m) { return word == m.first; });
    if (map == k_maps.end()) return false;
    OwnInput input;
    input.srgb = word == "map_kd";
    input.channel = input.srgb ? ImageChannel::rgb : ImageChannel::mean;
    std::string_view rest = cursor_.rest_of_line();
    while (rest.starts_with('-')) {
      std::string_view after = rest;
      const std::string option = in_small_letters(take_word(after));
      if (after.empty()) break;  // a file's name
      rest = after;
      if (!read_option(option, rest, input)) note("map_options");
    }
    if (rest.empty()) cursor_.fail_here("wanted a file behind {}, found none", word);
    // The file's v runs up, textures' from the image's top down.
    auto& [a, b, c, d, e, f] = input.uv_transform;
    e = -e;
    f = 1 - f;
    lines_->maps[map->second] = input;
    made_.images[map->second] = resolved(rest, file_.parent_path());
    return true;
  }

  void pass_over(const std::string& word) {
    constexpr auto is_in = [](const auto& words, const std::string& one) {
      return std::find(words.begin(), words.end(), one) != words.end();
    };
    constexpr std::array<std::string_view, 6> k_normals{"bump",     "map_bump", "norm",
                                                        "map_norm", "disp",     "map_disp"};
    constexpr std::array<std::string_view, 3> k_highlights{"map_ks", "map_ns", "refl"};
    constexpr std::array<std::string_view, 13> k_further{
        "ps",      "pc",        "pcr",        "aniso",   "anisor",  "map_ps", "map_pc",
        "map_pcr", "map_aniso", "map_anisor", "map_rma", "map_orm", "decal"};
    // Of lights that a path tracer has not, of colours of what is clear, and of how to make a picture.
    constexpr std::array<std::string_view, 6> k_without_effect{"ka", "map_ka",    "ni",
                                                               "tf", "sharpness", "map_aat"};
    if (word == "map_ke")
      lines_->shines = true;
    else if (word == "map_d" || word == "map_tr")
      lines_->has_alpha_map = true;
    else if (is_in(k_normals, word))
      note("normal_maps");
    else if (is_in(k_highlights, word))
      note("highlight_maps");
    else if (is_in(k_further, word))
      note("extensions");
    else if (!is_in(k_without_effect, word))
      note("unknown_lines");
  }

  /// In [0, 1].
  float share(double value) {
    if (value >= 0 && value <= 1) return static_cast<float>(value) + 0.0F;
    note("out_of_range");
    return value > 1 ? 1.0F : 0.0F;
  }

  Vec3 grey(double value) {
    const float x = share(value);
    return {x, x, x};
  }

  double roughness() const {
    constexpr double k_usual = 0.5;
    if (lines_->pr) return *lines_->pr;
    if (!lines_->ns) return k_usual;
    const double alpha = std::sqrt(2 / (std::max(*lines_->ns, 0.0) + 2));
    return std::sqrt(alpha);
  }

  double specular() const {
    if (lines_->illum < 2 && !lines_->is_physical()) return 0;
    if (lines_->ks) return ((*lines_->ks)[0] + (*lines_->ks)[1] + (*lines_->ks)[2]) / 3;
    constexpr double k_four_percent = 0.5;
    return lines_->is_physical() ? k_four_percent : 0;
  }

  OwnInput input_of(const char* name, Vec3 value) {
    OwnInput input;
    if (const auto map = lines_->maps.find(name); map != lines_->maps.end()) {
      input = map->second;
      if (name != std::string_view("basecolor")) return input;
      if (value == Vec3{}) {
        note("black_factor");
        value = {1, 1, 1};
      }
    }
    input.factor = value;
    return input;
  }

  void finish() {
    if (!lines_) return;
    const auto& l = *lines_;
    const bool clear = l.dissolve ? *l.dissolve < 1 : l.transparency && *l.transparency > 0;
    const bool glass = l.illum == 4 || l.illum == 6 || l.illum == 7 || l.illum == 9;
    if (clear || glass || l.has_alpha_map) note("transparency");
    if (l.shines) note("emission");
    auto& inputs = made_.material.inputs;
    inputs["basecolor"] = input_of("basecolor", {share(l.kd[0]), share(l.kd[1]), share(l.kd[2])});
    inputs["roughness"] = input_of("roughness", grey(roughness()));
    inputs["metallic"] = input_of("metallic", grey(l.pm.value_or(0)));
    inputs["specular"].factor = grey(specular());
    made_.material.name = l.name;
    into_.materials[l.name] = std::move(made_);
    lines_.reset();
  }

  fs::path file_;
  LineCursor cursor_;
  MtlDefinitions& into_;
  std::optional<Lines> lines_;  ///< of the material under way
  MtlMaterial made_;            ///< what becomes of them
};

}  // namespace

std::vector<fs::path> mtl_files(const std::vector<std::string>& lines, const std::string& obj) {
  const fs::path folder = fs::path(obj).parent_path();
  std::vector<fs::path> files;
  const auto add = [&](std::string_view name) {
    const fs::path file = resolved(name, folder);
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  };
  for (const std::string& line : lines) {
    std::string_view rest = line;
    const char* const begin = rest.data();
    std::size_t from = 0;
    while (!rest.empty()) {
      const std::string_view word = take_word(rest);
      const auto end = static_cast<std::size_t>(word.data() + word.size() - begin);
      if (!rest.empty() && !in_small_letters(word).ends_with(".mtl")) continue;
      add(trimmed(std::string_view(line).substr(from, end - from)));
      from = end;
    }
  }
  return files;
}

void parse_mtl(std::string_view text, const fs::path& file, MtlDefinitions& into) {
  if (is_utf16(text)) fail(ErrorKind::asset, "{}: {}", file.string(), k_utf16_message);
  MtlReader(without_bom(text), file, into).read();
}

OwnMaterials mtl_materials(const std::vector<fs::path>& files,
                           const std::vector<std::string>& names) {
  MtlDefinitions defined;
  for (const fs::path& file : files) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      fail(ErrorKind::asset,
           "{}: wanted the file that a model's own materials are in (mtllib), found none",
           file.string());
    parse_mtl(read_text_file(file), file, defined);
  }
  OwnMaterials own;
  own.notes = defined.notes;
  own.bare = light_grey();
  for (const std::string& name : names) {
    const auto at = defined.materials.find(name);
    if (at == defined.materials.end()) {
      ++own.notes["undefined"];
      own.materials.push_back(own.bare);
      own.materials.back().name = name;
      continue;
    }
    const MtlMaterial& found = at->second;
    own.materials.push_back(found.material);
    for (const auto& [input, file] : found.images)
      own.materials.back().inputs[input].image = image_number(own, {file, -1, {}});
    for (const auto& [note, count] : found.notes)
      own.notes[note] += count;
  }
  return own;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_reader.h"

#include "tracer/scene/sdl_math.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <system_error>

namespace ds {
namespace {

/// The words of all values: LuxCore reads "0.5 0.5 0.5" in quotes as three numbers too.
std::vector<std::string> words_of(const Property& property) {
  std::vector<std::string> words;
  for (const std::string& value : property.values)
    for (std::size_t start = value.find_first_not_of(" \t"); start != std::string::npos;) {
      const std::size_t end = value.find_first_of(" \t", start);
      words.push_back(value.substr(start, end - start));
      start = end == std::string::npos ? end : value.find_first_not_of(" \t", end);
    }
  return words;
}

std::string joined(const Property& property) {
  return fmt::format("{}", fmt::join(property.values, " "));
}

/// Takes a colour space prefix off the words and returns the exponent that makes the numbers
/// linear; nothing for one that is not supported.
std::optional<double> take_color_space(std::vector<std::string>& words) {
  if (words.empty()) return 1.0;
  if (words[0] == "nop") {
    words.erase(words.begin());
    return 1.0;
  }
  if (words[0] == "luxcore" && words.size() > 1) {
    const std::optional<double> gamma = parse_sdl_number(words[1]);
    words.erase(words.begin(), words.begin() + 2);
    if (gamma && *gamma > 0) return gamma;
    return std::nullopt;
  }
  return words[0] == "opencolorio" ? std::nullopt : std::optional(1.0);
}

double linear(double value, double gamma) {
  return gamma == 1 || value < 0 ? value : portable::pow(value, gamma);
}

}  // namespace

std::optional<double> parse_sdl_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_float = std::fabs(value) <= double{std::numeric_limits<float>::max()};
  if (error != std::errc() || end != text.data() + text.size() || !is_float) return std::nullopt;
  return value;
}

SdlNode::SdlNode(SdlReader& reader, SdlKind kind, std::string name)
    : reader_(&reader),
      kind_(kind),
      name_(std::move(name)),
      prefix_(fmt::format("{}.{}", section_of(kind), name_)) {}

std::string SdlNode::full_name(std::string_view property) const {
  return property.empty() ? prefix_ : fmt::format("{}.{}", prefix_, property);
}

const Property* SdlNode::use(std::string_view property) const {
  return reader_->properties.use(full_name(property));
}

SourcePlace SdlNode::place(std::string_view property) const {
  if (const Property* found = reader_->properties.find(full_name(property))) return found->place;
  const Property* first = reader_->properties.first_below(prefix_);
  return first ? first->place : SourcePlace{};
}

bool SdlNode::has(std::string_view property) const {
  return reader_->properties.find(full_name(property)) != nullptr;
}

std::string SdlNode::type(std::string_view default_type) const {
  return text("type").value_or(std::string(default_type));
}

void SdlNode::refuse_type(std::string_view type) const {
  reader_->properties.use_all(prefix_);
  if (luxcore_has_type(kind_, type))
    error("type", "{} type \"{}\" is not supported yet", word_for(kind_), type);
  else
    error("type", "{} type \"{}\" is unknown", word_for(kind_), type);
}

std::optional<std::string> SdlNode::text(std::string_view property) const {
  const Property* found = use(property);
  if (!found) return std::nullopt;
  if (found->values.size() == 1) return found->values[0];
  error(property, "wanted one value, found \"{}\"", joined(*found));
  return std::nullopt;
}

std::optional<std::vector<double>> SdlNode::numbers(std::string_view property,
                                                    std::size_t count) const {
  const Property* found = use(property);
  if (!found) return std::nullopt;
  std::vector<double> result;
  const std::vector<std::string> words = words_of(*found);
  for (const std::string& word : words)
    if (const std::optional<double> value = parse_sdl_number(word)) result.push_back(*value);
  if (words.size() == count && result.size() == count) return result;
  error(property, "wanted {}, found \"{}\"",
        count == 1 ? std::string("a number") : fmt::format("{} numbers", count), joined(*found));
  return std::nullopt;
}

std::optional<double> SdlNode::number(std::string_view property) const {
  const std::optional<std::vector<double>> values = numbers(property, 1);
  if (!values) return std::nullopt;
  return values->front();
}

double SdlNode::number(std::string_view property, double default_value) const {
  return number(property).value_or(default_value);
}

bool SdlNode::flag(std::string_view property, bool default_value) const {
  const Property* found = use(property);
  if (!found) return default_value;
  const std::string value = joined(*found);
  if (value == "1" || value == "true") return true;
  if (value == "0" || value == "false") return false;
  error(property, "wanted 0, 1, true or false, found \"{}\"", value);
  return default_value;
}

Vec3d SdlNode::vector(std::string_view property, Vec3d default_value) const {
  const std::optional<std::vector<double>> v = numbers(property, 3);
  return v ? Vec3d{(*v)[0], (*v)[1], (*v)[2]} : default_value;
}

Vec3d SdlNode::color(std::string_view property, Vec3d default_value) const {
  const Property* found = use(property);
  if (!found) return default_value;
  std::vector<std::string> words = words_of(*found);
  const std::optional<double> gamma = take_color_space(words);
  if (!gamma) {
    error(property, "colour space of \"{}\" is not supported yet", joined(*found));
    return default_value;
  }
  double v[3] = {0, 0, 0};
  bool good = words.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const std::optional<double> value = parse_sdl_number(words[i]);
    good = value && *value >= 0;
    if (good) v[i] = linear(*value, *gamma);
  }
  if (good) return {v[0], v[1], v[2]};
  error(property, "wanted three numbers that are not negative, found \"{}\"", joined(*found));
  return default_value;
}

Mat4 SdlNode::matrix(std::string_view property) const {
  Mat4 result;
  const std::optional<std::vector<double>> v = numbers(property, 16);
  if (!v) return result;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      result.m[row * 4 + column] = (*v)[column * 4 + row];
  const std::array<double, 16>& m = result.m;
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
    error(property, "wanted an affine matrix column by column, found {} {} {} {} as its last row",
          m[12], m[13], m[14], m[15]);
    return Mat4{};
  }
  if (portable::determinant(result) != 0) return result;
  error(property, "wanted a matrix that can be inverted, found one of determinant 0");
  return Mat4{};
}

std::optional<std::uint32_t> SdlNode::id(std::string_view property) const {
  const std::optional<double> value = number(property);
  if (!value) return std::nullopt;
  if (*value >= 0 && *value <= std::numeric_limits<std::uint32_t>::max() &&
      std::floor(*value) == *value)
    return static_cast<std::uint32_t>(*value);
  error(property, "wanted a whole number from 0 to 4294967295, found {}", *value);
  return std::nullopt;
}

std::optional<std::filesystem::path> SdlNode::file(std::string_view property) const {
  const std::optional<std::string> name = text(property);
  if (!name) return std::nullopt;
  std::filesystem::path path = reader_->folder / *name;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return path;
  error(property, "file {} does not exist", path.string());
  return std::nullopt;
}

std::vector<double> SdlNode::list(std::string_view property, std::size_t multiple) const {
  const Property* found = use(property);
  if (!found) return {};
  std::vector<double> result;
  for (const std::string& word : words_of(*found)) {
    const std::optional<double> value = parse_sdl_number(word);
    if (!value) {
      error(property, "wanted numbers, found \"{}\"", word);
      return {};
    }
    result.push_back(*value);
  }
  if (result.size() % multiple == 0) return result;
  error(property, "wanted a multiple of {} numbers, found {}", multiple, result.size());
  return {};
}

std::optional<TextureRef> SdlNode::texture(std::string_view property, int width) const {
  const Property* found = use(property);
  if (!found) return std::nullopt;
  TextureRef ref;
  const auto as_wanted = [&](TextureRef value) {
    if (width == 1 && value.texture < 0) {
      const Vec3 c = value.constant;
      if (c.x != c.y || c.y != c.z) {
        const float y = static_cast<float>(portable::luminance(to_double(c)));
        value.constant = {y, y, y};
      }
    }
    return value;
  };
  if (found->values.size() == 1) {
    const auto named = reader_->textures.find(found->values[0]);
    if (named != reader_->textures.end()) return as_wanted(named->second);
  }
  std::vector<std::string> words = words_of(*found);
  const std::optional<double> gamma = take_color_space(words);
  if (!gamma) {
    error(property, "colour space of \"{}\" is not supported yet", joined(*found));
    return std::nullopt;
  }
  std::vector<float> values;
  for (const std::string& word : words)
    if (const std::optional<double> value = parse_sdl_number(word))
      values.push_back(static_cast<float>(linear(*value, *gamma)));
  if (values.size() == words.size() && (values.size() == 1 || values.size() == 3)) {
    ref.constant = values.size() == 1 ? Vec3{values[0], values[0], values[0]}
                                      : Vec3{values[0], values[1], values[2]};
    return as_wanted(ref);
  }
  const std::string wrong = joined(*found);
  if (reader_->properties.first_below(fmt::format("scene.textures.{}", wrong)))
    error(property,
          "texture \"{}\" cannot be used here: it is defined below its use or has an error", wrong);
  else
    error(property, "wanted one number, three numbers or the name of a texture, found \"{}\"",
          wrong);
  return std::nullopt;
}

void SdlNode::read_row(const NodeType& row, std::vector<TextureRef>& inputs,
                       std::vector<float>& values) const {
  for (const InputType& input : row.inputs) {
    const float d = input.default_value;
    inputs.push_back(texture(input.name, input.width).value_or(TextureRef{{d, d, d}, -1}));
  }
  for (const NumberType& type : row.numbers) {
    const Property* found = use(type.name);
    if (found && found->values.size() == 1 &&
        (found->values[0] == "true" || found->values[0] == "false"))
      values.push_back(found->values[0] == "true" ? 1.0f : 0.0f);
    else
      values.push_back(static_cast<float>(number(type.name, double{type.default_value})));
  }
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_node.h"

#include "tracer/base/luminance.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_values.h"

#include <algorithm>
#include <cmath>
#include <system_error>

namespace ds {

SdlNode::SdlNode(SdlReader& reader, SdlKind kind, std::string name)
    : reader_(&reader),
      kind_(kind),
      name_(std::move(name)),
      prefix_(fmt::format("{}.{}", section_of(kind), name_)),
      section_(&sdl_section(kind)) {
  if (section_->types.size() == 1) row_ = &section_->types.front();
}

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

/// What is read and not in the table would be missing in the reference.
const SdlParameter& SdlNode::parameter(std::string_view property) const {
  const SdlParameter* found = find_parameter(*section_, row_, property);
  DS_ASSERT(found != nullptr);
  return *found;
}

void SdlNode::refer(SdlKind kind, const std::string& name) const {
  reader_->referred.insert(fmt::format("{}.{}", section_of(kind), name));
}

bool SdlNode::read_type() {
  std::string type(section_->default_type);
  if (const Property* found = use("type")) {
    if (found->values.size() != 1)
      error("type", "wanted one value, found \"{}\"", joined(*found));
    else
      type = found->values[0];
  }
  row_ = find_type(*section_, type);
  if (row_ == nullptr) refuse_type(type);
  return row_ != nullptr;
}

void SdlNode::refuse(const SdlParameter& wanted, const Property& found) const {
  const std::string value = joined(found);
  error(wanted.name, "wanted {}, found \"{}\"{}", wanted_text(wanted), value,
        did_you_mean(value, wanted.choices));
}

std::optional<std::string> SdlNode::text(std::string_view property) const {
  parameter(property);
  const Property* found = use(property);
  if (!found) return std::nullopt;
  if (found->values.size() == 1) return found->values[0];
  error(property, "wanted one value, found \"{}\"", joined(*found));
  return std::nullopt;
}

std::string SdlNode::choice(std::string_view property) const {
  const SdlParameter& wanted = parameter(property);
  const Property* found = use(property);
  if (!found) return wanted.default_value;
  std::string value = joined(*found);
  const auto& choices = wanted.choices;
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
  refuse(wanted, *found);
  return wanted.default_value;
}

std::optional<std::vector<double>> SdlNode::numbers(const SdlParameter& wanted,
                                                    std::size_t count) const {
  const Property* found = use(wanted.name);
  if (!found) return std::nullopt;
  std::vector<double> result;
  const std::vector<std::string> words = words_of(*found);
  for (const std::string& word : words)
    if (const std::optional<double> value = parse_sdl_number(word))
      if (wanted.range.contains(*value)) result.push_back(*value);
  if (words.size() == count && result.size() == count) return result;
  refuse(wanted, *found);
  return std::nullopt;
}

std::vector<double> SdlNode::numbers_or_default(std::string_view property,
                                                std::size_t count) const {
  const SdlParameter& wanted = parameter(property);
  if (const auto values = numbers(wanted, count)) return *values;
  std::vector<double> result;
  for (const std::string& word : words_of(Property{{}, {wanted.default_value}, {}, false}))
    result.push_back(parse_sdl_number(word).value());
  DS_ASSERT(result.size() == count);
  return result;
}

double SdlNode::number(std::string_view property) const {
  return numbers_or_default(property, 1)[0];
}

bool SdlNode::flag(std::string_view property) const {
  const SdlParameter& wanted = parameter(property);
  const bool default_value = wanted.default_value == "1";
  const Property* found = use(property);
  if (!found) return default_value;
  const std::string value = joined(*found);
  if (value == "1" || value == "true") return true;
  if (value == "0" || value == "false") return false;
  refuse(wanted, *found);
  return default_value;
}

std::array<double, 2> SdlNode::pair(std::string_view property) const {
  const std::vector<double> v = numbers_or_default(property, 2);
  return {v[0], v[1]};
}

Vec3d SdlNode::vector(std::string_view property) const {
  const std::vector<double> v = numbers_or_default(property, 3);
  return {v[0], v[1], v[2]};
}

Vec3d SdlNode::color(std::string_view property) const {
  const SdlParameter& wanted = parameter(property);
  Property value{{}, {wanted.default_value}, {}, false};
  const Property* found = use(property);
  if (found) value = *found;
  std::vector<std::string> words = words_of(value);
  const std::optional<double> gamma = take_color_space(words);
  double v[3] = {0, 0, 0};
  bool good = gamma && words.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const std::optional<double> number = parse_sdl_number(words[i]);
    good = number && wanted.range.contains(*number);
    if (good) v[i] = linear(*number, *gamma);
  }
  if (good) return {v[0], v[1], v[2]};
  DS_ASSERT(found != nullptr);  // the default is right
  if (!gamma)
    error(property, "colour space of \"{}\" is not supported yet", joined(*found));
  else
    refuse(wanted, *found);
  return {};
}

Mat4 SdlNode::matrix(std::string_view property) const {
  Mat4 result;
  const std::optional<std::vector<double>> v = numbers(parameter(property), 16);
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

std::uint32_t SdlNode::id(std::string_view property) const {
  const double value = number(property);
  if (std::floor(value) == value) return static_cast<std::uint32_t>(value);
  refuse(parameter(property), *use(property));
  return 0;
}

std::optional<std::filesystem::path> SdlNode::file(std::string_view property) const {
  const std::optional<std::string> name = text(property);
  if (!name) return std::nullopt;
  std::filesystem::path path = reader_->folder / *name;
  reader_->files.push_back(path);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) return path;
  reader_->broken.insert(prefix_);
  // One missing file is one finding, however often it is used.
  if (reader_->missed.insert(path.string()).second) {
    if (std::filesystem::exists(path, ignored))
      error(property, "wanted a file, found a folder or a device: {}", path.string());
    else
      error(property, "file {} does not exist{}", path.string(), similar_name(path));
  }
  return std::nullopt;
}

std::optional<std::vector<double>> SdlNode::list(std::string_view property,
                                                 std::size_t multiple) const {
  parameter(property);
  const Property* found = use(property);
  std::vector<double> result;
  if (!found) return result;
  for (const std::string& word : words_of(*found)) {
    const std::optional<double> value = parse_sdl_number(word);
    if (!value) {
      error(property, "wanted numbers, found \"{}\"", word);
      return std::nullopt;
    }
    result.push_back(*value);
  }
  if (result.size() % multiple == 0) return result;
  error(property, "wanted a multiple of {} numbers, found {}", multiple, result.size());
  return std::nullopt;
}

std::optional<TextureRef> SdlNode::texture(std::string_view property) const {
  const SdlParameter& wanted = parameter(property);
  const int width = wanted.type == SdlType::scalar_input ? 1 : 3;
  const Property* found = use(property);
  if (!found) return std::nullopt;
  TextureRef ref;
  const auto as_wanted = [&](TextureRef value) {
    if (width == 1 && value.texture < 0) {
      const Vec3 c = value.constant;
      if (c.x != c.y || c.y != c.z) {
        const float y = static_cast<float>(luxcore_luminance(c));
        value.constant = {y, y, y};
      }
    }
    return value;
  };
  if (found->values.size() == 1) {
    refer(SdlKind::texture, found->values[0]);
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
  bool in_range = true;
  for (const std::string& word : words) {
    const std::optional<double> value = parse_sdl_number(word);
    if (!value) continue;
    in_range = in_range && wanted.range.contains(*value);
    values.push_back(static_cast<float>(linear(*value, *gamma)));
  }
  if (in_range && values.size() == words.size() && (values.size() == 1 || values.size() == 3)) {
    ref.constant = values.size() == 1 ? Vec3{values[0], values[0], values[0]}
                                      : Vec3{values[0], values[1], values[2]};
    return as_wanted(ref);
  }
  const std::string wrong = joined(*found);
  const bool is_name = found->values.size() == 1 && !parse_sdl_number(wrong);
  if (is_name && reader_->broken.contains("scene.textures." + wrong)) return std::nullopt;
  if (is_name && reader_->properties.first_below(fmt::format("scene.textures.{}", wrong))) {
    error(property, "texture \"{}\" cannot be used here: it is defined below its use{}", wrong,
          reader_->conductors.contains(wrong) ? ", or is for metal2's fresnel only" : "");
  } else {
    std::vector<std::string_view> names;
    for (const auto& [name, known] : reader_->textures)
      names.emplace_back(name);
    error(property, "wanted {}, found \"{}\"{}", wanted_text(wanted), wrong,
          is_name ? did_you_mean(wrong, names) : "");
  }
  return std::nullopt;
}

void SdlNode::read_row(const NodeType& row, std::vector<TextureRef>& inputs,
                       std::vector<float>& values) const {
  for (const InputType& input : row.inputs) {
    const float d = input.default_value;
    inputs.push_back(texture(input.name).value_or(TextureRef{{d, d, d}, -1}));
  }
  for (const NumberType& type : row.numbers)
    values.push_back(parameter(type.name).type == SdlType::flag
                         ? (flag(type.name) ? 1.0f : 0.0f)
                         : static_cast<float>(number(type.name)));
}

}  // namespace ds

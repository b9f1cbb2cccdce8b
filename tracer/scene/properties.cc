// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/properties.h"

#include "tracer/base/files.h"
#include "tracer/base/text_lines.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace ds {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back()))
    text.remove_suffix(1);
  return text;
}

/// Takes a quoted value off the front of `rest`; nothing where its end is missing.
std::optional<std::string> take_quoted(std::string_view& rest) {
  const char quote = rest.front();
  std::string value;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == quote) {
      rest.remove_prefix(i + 1);
      return value;
    }
    value += rest[i];
  }
  return std::nullopt;
}

std::optional<std::string> take_blob(std::string_view& rest) {
  const std::size_t end = rest.find("]}");
  if (end == std::string_view::npos) return std::nullopt;
  std::string value(rest.substr(2, end - 2));
  rest.remove_prefix(end + 2);
  return value;
}

std::string take_word(std::string_view& rest) {
  const std::size_t end = rest.find_first_of(" \t");
  std::string value(rest.substr(0, end));
  rest.remove_prefix(value.size());
  return value;
}

/// Splits the text after "="; false, with one finding, where it cannot be.
bool split_values(std::string_view rest, Property& property, Diagnostics& diagnostics) {
  for (rest = trim(rest); !rest.empty(); rest = trim(rest)) {
    std::optional<std::string> value;
    const char* wanted = "";
    if (rest.front() == '"' || rest.front() == '\'') {
      wanted = "a closing quote";
      value = take_quoted(rest);
    } else if (rest.substr(0, 2) == "{[") {
      wanted = "\"]}\" at the end of a blob";
      value = take_blob(rest);
    } else {
      value = take_word(rest);
    }
    if (!value) {
      diagnostics.add(property.place, "{}: wanted {}, found the end of the line", property.name,
                      wanted);
      return false;
    }
    property.values.push_back(std::move(*value));
  }
  if (!property.values.empty()) return true;
  diagnostics.add(property.place, "{} has no value", property.name);
  return false;
}

bool starts_with_part(std::string_view name, std::string_view prefix) {
  return name.size() > prefix.size() && name[prefix.size()] == '.' && name.starts_with(prefix);
}

}  // namespace

PropertySet PropertySet::parse(std::string_view text, const std::string& file,
                               Diagnostics& diagnostics) {
  PropertySet set;
  if (is_utf16(text)) {
    diagnostics.add({file}, "{}", k_utf16_message);
    return set;
  }
  text = without_bom(text);
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::string_view line = take_line(text);
    if (trim(line).empty() || trim(line).front() == '#') continue;

    Property property;
    property.place = {file, line_number, 0};
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      diagnostics.add(property.place, "wanted \"name = values\", found \"{}\"", trim(line));
      continue;
    }
    property.name = std::string(trim(line.substr(0, equals)));
    if (property.name.empty()) {
      diagnostics.add(property.place, "wanted a property name before \"=\", found none");
      continue;
    }
    if (split_values(line.substr(equals + 1), property, diagnostics)) set.set(std::move(property));
  }
  return set;
}

PropertySet PropertySet::read(const std::filesystem::path& file, Diagnostics& diagnostics) {
  return parse(read_text_file(file), file.string(), diagnostics);
}

void PropertySet::set(Property property) {
  const auto [entry, is_new] = index_.emplace(property.name, properties_.size());
  if (is_new) {
    properties_.push_back(std::move(property));
    return;
  }
  note_repeat(properties_[entry->second], property);
  properties_[entry->second] = std::move(property);
}

void PropertySet::put(std::string name, std::vector<std::string> values) {
  const auto [entry, is_new] = index_.emplace(name, properties_.size());
  if (is_new)
    properties_.push_back({std::move(name), std::move(values), {}, false});
  else
    properties_[entry->second].values = std::move(values);
}

void PropertySet::note_repeat(const Property& first, const Property& last) {
  const auto known =
      std::find_if(repeated_.begin(), repeated_.end(),
                   [&](const RepeatedProperty& one) { return one.name == last.name; });
  if (known != repeated_.end())
    known->last = last.place;
  else
    repeated_.push_back({last.name, first.place, last.place});
}

const Property* PropertySet::find(std::string_view name) const {
  const auto entry = index_.find(name);
  return entry == index_.end() ? nullptr : &properties_[entry->second];
}

const Property* PropertySet::use(std::string_view name) {
  const auto entry = index_.find(name);
  if (entry == index_.end()) return nullptr;
  properties_[entry->second].used = true;
  return &properties_[entry->second];
}

void PropertySet::use_all(std::string_view prefix) {
  for (Property& property : properties_)
    if (property.name == prefix || starts_with_part(property.name, prefix)) property.used = true;
}

void PropertySet::rename_prefix(std::string_view from, std::string_view to) {
  for (Property& property : properties_)
    if (starts_with_part(property.name, from))
      property.name = std::string(to) + property.name.substr(from.size());
  index_.clear();
  for (std::size_t i = 0; i < properties_.size(); ++i)
    index_.emplace(properties_[i].name, i);
}

std::vector<std::string> PropertySet::names_below(std::string_view prefix) const {
  std::vector<std::string> names;
  for (const Property& property : properties_) {
    if (!starts_with_part(property.name, prefix)) continue;
    const std::string_view rest = std::string_view(property.name).substr(prefix.size() + 1);
    const std::string name(rest.substr(0, rest.find('.')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

const Property* PropertySet::first_below(std::string_view prefix) const {
  for (const Property& property : properties_)
    if (starts_with_part(property.name, prefix)) return &property;
  return nullptr;
}

std::vector<const Property*> PropertySet::unused() const {
  std::vector<const Property*> result;
  for (const Property& property : properties_)
    if (!property.used) result.push_back(&property);
  return result;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/value.h"

#include "tracer/base/text_lines.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

namespace ds {
namespace {

// A recipe is written by hand. toml++ recurses once a level of nesting, a dotted key's parts
// included, so a longer or deeper text is refused before it can exhaust the stack.
constexpr std::size_t k_max_bytes = 16u << 20;
constexpr std::size_t k_max_key_parts = 32;

/// The most dots between two characters that cannot stand in a bare dotted key; dots in a row count
/// once.
std::size_t longest_dotted_key(std::string_view text) {
  std::size_t most = 0, dots = 0;
  char previous = '\n';
  for (const char c : text) {
    if (c == '.' && previous != '.') most = std::max(most, ++dots);
    if (c == '=' || c == '\n' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') dots = 0;
    previous = c;
  }
  return most;
}

/// Every line ends with "\n": TOML knows no other end but "\r\n".
std::string with_newlines(std::string_view text) {
  text = without_bom(text);
  std::string lines;
  lines.reserve(text.size());
  while (!text.empty()) {
    const std::string_view before = text;
    const std::string_view line = take_line(text);
    lines += line;
    if (line.size() < before.size()) lines += '\n';
  }
  return lines;
}

SourcePlace place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// Copies the library's tree into ours.
class Converter {
 public:
  Converter(std::string file, bool from_set, Diagnostics& diagnostics)
      : file_(std::move(file)), from_set_(from_set), diagnostics_(diagnostics) {}

  RecipeValue::Table table(const toml::table& from) {
    RecipeValue::Table to;
    for (const auto& [key, node] : from) {
      RecipeValue converted = value(node);
      // A finding about a whole section points at its name.
      if (node.is_table() && !node.as_table()->is_inline()) converted.place = place(key.source());
      to.emplace(std::string(key.str()), std::move(converted));
    }
    return to;
  }

  RecipeValue value(const toml::node& node) {
    RecipeValue to{{}, place(node.source()), from_set_};
    if (const auto* t = node.as_table()) {
      to.value = table(*t);
    } else if (const auto* a = node.as_array()) {
      RecipeValue::Array& elements = to.value.emplace<RecipeValue::Array>();
      for (const toml::node& element : *a)
        elements.push_back(value(element));
    } else if (const auto* s = node.as_string()) {
      to.value = s->get();
    } else if (const auto* i = node.as_integer()) {
      to.value = i->get();
    } else if (const auto* f = node.as_floating_point()) {
      to.value = f->get();
    } else if (const auto* b = node.as_boolean()) {
      to.value = b->get();
    } else {
      diagnostics_.add(to.place, "no key takes a date or time; a string wants quotes");
    }
    return to;
  }

 private:
  SourcePlace place(const toml::source_region& region) const {
    return from_set_ ? SourcePlace{file_, 0, 0} : place_of(region, file_);
  }

  std::string file_;
  bool from_set_;
  Diagnostics& diagnostics_;
};

std::vector<std::string> split_key(std::string_view key) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= key.size();) {
    const std::size_t end = std::min(key.find('.', at), key.size());
    parts.emplace_back(key.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

/// A value of the line that lacks its quotes: "my data" of `name = my data`, "a.off" of `files =
/// [a.off]`. Nothing where none does.
std::optional<std::string> unquoted_value(std::string_view line) {
  constexpr std::string_view k_blank = " \t\r";
  line = line.substr(std::min(line.find('=') + 1, line.size()));
  line = line.substr(std::min(line.find_first_not_of(k_blank), line.size()));
  const bool is_list = line.starts_with('[') || line.starts_with('{');
  for (std::size_t at = 0; at < line.size();) {
    const char c = line[at];
    if (c == '#') break;
    if (std::string_view(" \t\r,[]{}").find(c) != std::string_view::npos) {
      ++at;
      continue;
    }
    if (c == '"' || c == '\'') {
      at = std::min(line.find(c, at + 1), line.size() - 1) + 1;
      continue;
    }
    const std::size_t end =
        std::min(line.find_first_of(is_list ? ",[]{}#\"' \t" : "#\"'", at + 1), line.size());
    std::string_view word = line.substr(at, end - at);
    word = word.substr(0, word.find_last_not_of(k_blank) + 1);
    const bool is_bare = std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '.' ||
                         c == '~' || c == '_';
    if (is_bare && word != "true" && word != "false" && word != "inf" && word != "nan")
      return std::string(word);
    at = end;
  }
  return std::nullopt;
}

/// What a word of another format is in TOML; "" for any other word.
std::string_view boolean_meant(std::string_view word) {
  const auto is_one_of = [word](std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (is_one_of({"true", "yes", "on"})) return "true";
  return is_one_of({"false", "no", "off"}) ? "false" : "";
}

/// Whether a key may stand without quotes.
bool is_bare(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  });
}

std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && !text.empty(); --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

/// What toml++ says of a string without quotes speaks of whatever it might have been instead.
std::string explained(const toml::parse_error& error, std::string_view text) {
  const std::string_view line = line_of(text, error.source().begin.line);
  const std::optional<std::string> value =
      line.find('=') == line.npos ? std::nullopt : unquoted_value(line);
  if (!value) return fmt::format("must be TOML: {}", error.description());
  std::string lower = *value;
  for (char& c : lower)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (const std::string_view meant = boolean_meant(lower); !meant.empty())
    return fmt::format("must be TOML: wanted {}, got {}", meant, *value);
  return fmt::format("must be TOML: a string wants quotes: {}, got {}", to_toml(*value), *value);
}

/// The value of the TOML document "v = text", or nothing where that is none or holds more than one
/// value.
std::optional<toml::table> parse_one_value(std::string_view text) {
  if (longest_dotted_key(text) > k_max_key_parts) return std::nullopt;
  try {
    toml::table document = toml::parse("v = " + std::string(text));
    if (document.size() == 1 && document.contains("v")) return document;
  } catch (const toml::parse_error&) {
    // Not TOML: the caller takes it as a string.
  }
  return std::nullopt;
}

}  // namespace

double RecipeValue::number() const {
  const std::int64_t* whole = integer();
  return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value);
}

std::string to_toml(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string to_toml(const RecipeValue& value) {
  if (const auto* text = value.text()) return to_toml(*text);
  if (const auto* whole = value.integer()) return fmt::format("{}", *whole);
  if (const auto* flag = value.boolean()) return *flag ? "true" : "false";
  if (const auto* array = value.array()) {
    std::string list;
    for (const RecipeValue& element : *array)
      list += (list.empty() ? "" : ", ") + to_toml(element);
    return "[" + list + "]";
  }
  if (const auto* table = value.table()) {
    std::string list;
    for (const auto& [key, member] : *table)
      list += (list.empty() ? "" : ", ") + (is_bare(key) ? key : to_toml(key)) + " = " +
              to_toml(member);
    return "{" + list + "}";
  }
  std::string digits = fmt::format("{}", value.number());
  if (digits.find_first_of(".en") == digits.npos) digits += ".0";
  return digits;
}

RecipeValue with_numbers(RecipeValue value) {
  if (value.is_number()) value.value = value.number();
  if (auto* list = std::get_if<RecipeValue::Array>(&value.value))
    for (RecipeValue& element : *list)
      element = with_numbers(std::move(element));
  if (auto* table = value.table())
    for (auto& [key, member] : *table)
      member = with_numbers(std::move(member));
  return value;
}

RecipeValue::Table parse_recipe_text(std::string_view bytes, const std::string& file,
                                     Diagnostics& diagnostics) {
  if (bytes.size() > k_max_bytes) {
    diagnostics.add({file, 0, 0}, "a recipe must be at most {} bytes, got {}", k_max_bytes,
                    bytes.size());
    return {};
  }
  if (is_utf16(bytes)) {
    diagnostics.add({file, 0, 0}, "{}", k_utf16_message);
    return {};
  }
  const std::string text = with_newlines(bytes);
  if (const std::size_t parts = longest_dotted_key(text); parts > k_max_key_parts) {
    diagnostics.add({file, 0, 0}, "a key must have at most {} parts, got {}", k_max_key_parts,
                    parts);
    return {};
  }
  try {
    return Converter(file, false, diagnostics).table(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    diagnostics.add(place_of(error.source(), file), "{}", explained(error, text));
    return {};
  }
}

void apply_override(std::string_view assignment, RecipeValue::Table& recipe,
                    Diagnostics& diagnostics) {
  const std::size_t equals = assignment.find('=');
  const std::string key(assignment.substr(0, equals));
  const std::vector<std::string> parts = split_key(key);
  const bool empty_part =
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); });
  if (equals == assignment.npos || empty_part || parts.size() > k_max_key_parts) {
    diagnostics.add({"--set", 0, 0}, "wants section.key=value, got {:?}", assignment);
    return;
  }
  const std::string_view text = assignment.substr(equals + 1);
  Converter converter("--set " + key, true, diagnostics);
  RecipeValue value{std::string(text), {"--set " + key, 0, 0}, true};
  if (const auto document = parse_one_value(text)) value = converter.value(*document->get("v"));

  RecipeValue::Table* table = &recipe;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    RecipeValue& next = (*table)[parts[i]];
    if (next.table() == nullptr) next = {RecipeValue::Table{}, value.place, true};
    table = next.table();
  }
  (*table)[parts.back()] = std::move(value);
}

RecipeValue parse_value(std::string_view text) {
  const auto document = parse_one_value(text);
  DS_ASSERT(document.has_value());
  Diagnostics diagnostics(ErrorKind::recipe);
  return Converter("", false, diagnostics).value(*document->get("v"));
}

}  // namespace ds

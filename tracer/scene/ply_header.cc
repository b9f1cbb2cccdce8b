// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/ply_header.h"

#include "tracer/base/error.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

namespace ds {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array k_type_names{
    TypeName{"char", PlyType::int8},      TypeName{"int8", PlyType::int8},
    TypeName{"uchar", PlyType::uint8},    TypeName{"uint8", PlyType::uint8},
    TypeName{"short", PlyType::int16},    TypeName{"int16", PlyType::int16},
    TypeName{"ushort", PlyType::uint16},  TypeName{"uint16", PlyType::uint16},
    TypeName{"int", PlyType::int32},      TypeName{"int32", PlyType::int32},
    TypeName{"uint", PlyType::uint32},    TypeName{"uint32", PlyType::uint32},
    TypeName{"float", PlyType::float32},  TypeName{"float32", PlyType::float32},
    TypeName{"double", PlyType::float64}, TypeName{"float64", PlyType::float64},
};

/// No model has more elements, nor an element more properties; looking for names that occur twice
/// stays cheap in a file made to be slow.
constexpr std::size_t k_most_parts = 1000;

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    const std::size_t end = bytes.find_first_of("\r\n");
    eol_ = bytes[end] == '\r' && !bytes.substr(end).starts_with("\r\n") ? '\r' : '\n';
  }

  PlyHeader parse() {
    next_line();  // "ply"
    for (bool has_format = false; next_line();) {
      const std::string_view keyword = word();
      if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "end_header") {
        end_of_line();
        if (!has_format) fail_here("end_header before a format line");
        header_.body_offset = at_;
        header_.body_line = line_number_ + 1;
        return std::move(header_);
      }
      if (keyword == "format") {
        if (std::exchange(has_format, true)) fail_here("a second format line");
        parse_format();
      } else if (keyword == "element") {
        parse_element();
      } else if (keyword == "property") {
        parse_property();
      } else {
        fail_here("unknown header keyword \"{}\"", printable(keyword));
      }
    }
    fail_here("cut off in the header: no end_header");
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorKind::asset, "{}:{}: {}", name_, line_number_,
         fmt::format(format, std::forward<Args>(args)...));
  }

  bool next_line() {
    if (at_ == bytes_.size()) return false;
    ++line_number_;
    const std::size_t end = bytes_.find(eol_, at_);
    line_ = bytes_.substr(at_, end == bytes_.npos ? bytes_.npos : end - at_);
    at_ = end == bytes_.npos ? bytes_.size() : end + 1;
    return true;
  }

  std::string_view word() {
    // Whatever ends no line is blank: some writers end only some lines with both.
    constexpr std::string_view k_blanks = " \t\r\n";
    line_.remove_prefix(std::min(line_.find_first_not_of(k_blanks), line_.size()));
    const std::string_view found = line_.substr(0, line_.find_first_of(k_blanks));
    line_.remove_prefix(found.size());
    return found;
  }

  void end_of_line() {
    const std::string_view extra = word();
    if (!extra.empty()) fail_here("wanted the end of the line, found \"{}\"", printable(extra));
  }

  void parse_format() {
    const std::string_view format = word();
    if (format == "ascii")
      header_.format = PlyFormat::ascii;
    else if (format == "binary_little_endian")
      header_.format = PlyFormat::binary_little_endian;
    else if (format == "binary_big_endian")
      header_.format = PlyFormat::binary_big_endian;
    else
      fail_here("format must be ascii, binary_little_endian or binary_big_endian, got \"{}\"",
                printable(format));
    const std::string_view version = word();
    if (version != "1.0") fail_here("version must be 1.0, got \"{}\"", printable(version));
    end_of_line();
  }

  void parse_element() {
    PlyElement element;
    element.name = word();
    element.line = line_number_;
    const std::string_view count = word();
    const char* end = count.data() + count.size();
    const auto [stop, code] = std::from_chars(count.data(), end, element.count);
    if (count.empty() || code != std::errc() || stop != end)
      fail_here("count of element {} must be an integer of at least 0, got \"{}\"",
                printable(element.name), printable(count));
    end_of_line();
    for (const PlyElement& earlier : header_.elements)
      if (earlier.name == element.name) fail_here("a second element {}", printable(element.name));
    if (header_.elements.size() == k_most_parts) fail_here("more than {} elements", k_most_parts);
    header_.elements.push_back(std::move(element));
  }

  PlyType parse_type() {
    const std::string_view type = word();
    for (const TypeName& known : k_type_names)
      if (known.name == type) return known.type;
    fail_here("unknown type \"{}\"", printable(type));
  }

  void parse_property() {
    if (header_.elements.empty()) fail_here("a property before the first element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    const std::string_view before = line_;
    if (word() == "list") {
      property.count_type = parse_type();
      if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64)
        fail_here("the count of a list must have an integer type");
    } else {
      line_ = before;
    }
    property.type = parse_type();
    property.name = word();
    if (property.name.empty()) fail_here("a property without a name");
    end_of_line();
    for (const PlyProperty& earlier : element.properties)
      if (earlier.name == property.name)
        fail_here("a second property {} of element {}", printable(property.name),
                  printable(element.name));
    if (element.properties.size() == k_most_parts)
      fail_here("more than {} properties of element {}", k_most_parts, printable(element.name));
    element.properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  char eol_ = '\n';        ///< the last character of every line's end; the first line tells which
  std::string_view line_;  ///< what is left of the current line
  std::size_t at_ = 0;     ///< where the next line starts
  std::uint64_t line_number_ = 0;
  const std::string& name_;
  PlyHeader header_;
};

}  // namespace

std::size_t size_bytes(PlyType type) {
  constexpr std::array<std::size_t, 8> k_sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return k_sizes[static_cast<std::size_t>(type)];
}

bool is_ply(std::string_view bytes) {
  const std::size_t end = bytes.find_first_not_of(" \t", 3);
  return bytes.starts_with("ply") && end != bytes.npos &&
         (bytes[end] == '\n' || bytes[end] == '\r');
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  DS_ASSERT(is_ply(bytes));
  return HeaderParser(bytes, name).parse();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The header of a PLY file (Greg Turk's "The PLY Polygon File Format", version 1.0):
///
///   header   = "ply" EOL "format" FORMAT "1.0" EOL {line} "end_header" EOL
///   FORMAT   = "ascii" | "binary_little_endian" | "binary_big_endian"
///   line     = "comment" text EOL | "obj_info" text EOL | element | EOL
///   element  = "element" NAME COUNT EOL {property | comment | obj_info}
///   property = "property" TYPE NAME EOL | "property" "list" INTEGER_TYPE TYPE NAME EOL
///   EOL      = "\n" | "\r\n" | "\r"; "\r" throughout where it stands after "ply"
enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  ///< of a list; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  ///< where the header defines it
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t body_offset = 0;  ///< bytes from the start of the file
  std::uint64_t body_line = 0;  ///< line number of the body's first line
};

/// Whether a file begins as one does.
bool is_ply(std::string_view bytes);

/// Names of elements, and of properties within one, are distinct. Throws Error(asset).
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace ds

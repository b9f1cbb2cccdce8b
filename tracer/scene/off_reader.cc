// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/mesh_text.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

// The text form of Geomview's OFF (the manual's "OFF Files"), one vertex and one face a line:
//
//   file    = keyword VERTICES FACES [EDGES] EOL {vertex} {face}
//   keyword = {"ST" | "C" | "N"} "OFF", then blanks, EOL or nothing at all before the counts
//   vertex  = X Y Z [NX NY NZ] [R G B [A]] [S T] EOL      normal with N, colour with C, uv with ST
//   face    = CORNERS {INDEX} {COLOUR} EOL                0 to 4 colour values, not used
//
// "#" begins a comment up to the end of the line; blank lines mean nothing. The edge count is not
// checked. "4OFF" and "nOFF" (other than three coordinates) and "OFF BINARY" are refused.

namespace ds {
namespace {

struct OffKeyword {
  bool uvs = false, colours = false, normals = false;
  bool other_dimensions = false;
  std::size_t size = 0;  ///< characters
};

/// The keyword a word starts with; nothing where it is none.
std::optional<OffKeyword> parse_keyword(std::string_view word) {
  const std::size_t off = word.find("OFF");
  if (off == word.npos) return std::nullopt;
  const std::string_view behind = word.substr(off + 3);
  if (!behind.empty() && (behind[0] < '0' || behind[0] > '9')) return std::nullopt;
  OffKeyword keyword;
  keyword.size = off + 3;
  for (std::string_view prefix = word.substr(0, off); !prefix.empty();) {
    const bool two = prefix.starts_with("ST");
    if (two)
      keyword.uvs = true;
    else if (prefix[0] == 'C')
      keyword.colours = true;
    else if (prefix[0] == 'N')
      keyword.normals = true;
    else if (prefix[0] == '4' || prefix[0] == 'n')
      keyword.other_dimensions = true;
    else
      return std::nullopt;
    prefix.remove_prefix(two ? 2 : 1);
  }
  return keyword;
}

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& name) : cursor_(name, bytes, 1, '#') {}

  Polygons read() {
    read_keyword();
    read_counts();
    read_vertices();
    read_faces();
    if (cursor_.next_line()) cursor_.fail_here("text behind the last face the header promises");
    return std::move(out_);
  }

 private:
  void read_keyword() {
    cursor_.next_line();
    const std::string_view word = cursor_.word();
    const std::optional<OffKeyword> keyword = parse_keyword(word);
    DS_ASSERT(keyword.has_value());
    keyword_ = *keyword;
    if (keyword_.other_dimensions)
      cursor_.fail_here("{} is not supported: vertices must have three coordinates",
                        printable(word));
    cursor_.put_back(word.size() - keyword_.size);
  }

  std::uint64_t read_count(const char* what) {
    if (cursor_.line_done()) cursor_.fail_here("wanted the number of {}, found nothing", what);
    const std::int64_t count = cursor_.integer();
    if (count < 0) cursor_.fail_here("the number of {} must be at least 0, got {}", what, count);
    return static_cast<std::uint64_t>(count);
  }

  void read_counts() {
    if (cursor_.line_done() && !cursor_.next_line()) cursor_.fail_here("cut off before the counts");
    if (cursor_.rest_starts_with("BINARY")) cursor_.fail_here("OFF BINARY is not supported");
    vertices_ = read_count("vertices");
    faces_ = read_count("faces");
    if (!cursor_.line_done()) cursor_.number();  // edges
    if (!cursor_.line_done()) cursor_.fail_here("more than three counts");
  }

  void read_vertices() {
    const std::size_t normals = keyword_.normals ? 3 : 0, uvs = keyword_.uvs ? 2 : 0;
    const std::size_t least = 3 + normals + (keyword_.colours ? 3 : 0) + uvs;
    const std::size_t most = least + (keyword_.colours ? 1 : 0);
    const std::size_t expected = believable(vertices_, cursor_.bytes_left(), 2 * least);
    out_.positions.reserve(expected);
    if (keyword_.normals) out_.normals.reserve(expected);
    if (keyword_.uvs) out_.uvs.reserve(expected);

    std::array<double, 3 + 3 + 4 + 2> row{};
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      if (!cursor_.next_line())
        cursor_.fail_here("cut off: the header promises {} vertices, found {}", vertices_, i);
      std::size_t found = 0;
      for (; !cursor_.line_done() && found < most; ++found)
        row[found] = cursor_.number() + 0.0;  // -0 becomes 0
      if (found < least || !cursor_.line_done())
        cursor_.fail_here("vertex {} must have {} values, found {}", i, least,
                          cursor_.line_done() ? "fewer" : "more");
      out_.positions.push_back({row[0], row[1], row[2]});
      if (keyword_.normals) out_.normals.push_back(to_mesh_floats({row[3], row[4], row[5]}));
      if (keyword_.uvs)
        out_.uvs.push_back({to_mesh_float(row[found - 2]), to_mesh_float(row[found - 1])});
    }
  }

  void read_faces() {
    constexpr int k_most_colour_values = 4;
    out_.face_ends.reserve(believable(faces_, cursor_.bytes_left(), 2));
    for (std::uint64_t i = 0; i < faces_; ++i) {
      if (!cursor_.next_line())
        cursor_.fail_here("cut off: the header promises {} faces, found {}", faces_, i);
      const std::int64_t corners = cursor_.integer();
      if (corners < 0) cursor_.fail_here("face {} has {} corners", i, corners);
      for (std::int64_t c = 0; c < corners; ++c) {
        if (cursor_.line_done())
          cursor_.fail_here("face {} must have {} corners, found {}", i, corners, c);
        out_.corners.push_back(cursor_.index());
      }
      out_.face_ends.push_back(out_.corners.size());
      for (int k = 0; k < k_most_colour_values && !cursor_.line_done(); ++k)
        cursor_.number();
      if (!cursor_.line_done())
        cursor_.fail_here("face {} has more than {} corners and a colour", i, corners);
    }
  }

  LineCursor cursor_;
  OffKeyword keyword_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  Polygons out_;
};

}  // namespace

bool is_off(std::string_view bytes) {
  LineCursor cursor("", bytes, 1, '#');
  return cursor.next_line() && parse_keyword(cursor.word()).has_value();
}

Polygons read_off(std::string_view bytes, const std::string& name) {
  DS_ASSERT(is_off(bytes));
  return OffReader(bytes, name).read();
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

// The text form of Geomview's OFF (the manual's "OFF Files"):
//
//   file    = [keyword] VERTICES FACES [EDGES] EOL {vertex} {face}
//   keyword = {"ST" | "C" | "N"} "OFF", then blanks, EOL or nothing at all before the counts
//   vertex  = X Y Z [NX NY NZ] [R G B [A]] [S T]          normal with N, colour with C, uv with ST
//   face    = CORNERS {INDEX} {COLOUR}                    0 to 4 colour values; 3 or 4 are R G B [A]
//
// "#" begins a comment up to the end of the line; blank lines mean nothing. The edge count is not
// checked. "4OFF" and "nOFF" (other than three coordinates) and "OFF BINARY" are refused.
//
// Most files have one vertex and one face a line, and so they are read first. What does not fit that
// is read with vertices and faces that start on lines of their own and go on over several; and
// where that does not fit either, without regard to lines, where faces can have no colour and colours
// of vertices have four values. Where nothing fits, the error is the first reading's. Without C a
// vertex may have a colour all the same, where all have (3 or 4 further values, none below 0). One
// last line that is no face may follow and is counted, not read.

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

/// How lines bound vertices and faces.
enum class Lines { one_each, start_each, mean_nothing };

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& name) : cursor_(name, bytes, 1, '#') {}

  Polygons read() {
    read_keyword();
    read_counts();
    const LineCursor body = cursor_;
    std::optional<Error> first;
    for (const Lines lines : {Lines::one_each, Lines::start_each, Lines::mean_nothing}) {
      lines_ = lines;
      cursor_ = body;
      out_ = {};
      try {
        read_vertices();
        read_faces();
        read_end();
        return std::move(out_);
      } catch (const Error& error) {
        if (!first) first = error;
      }
    }
    throw *first;
  }

 private:
  void read_keyword() {
    cursor_.next_line();
    LineCursor before = cursor_;
    const std::string_view word = cursor_.word();
    const std::optional<OffKeyword> keyword = parse_keyword(word);
    if (!keyword) {
      cursor_ = std::move(before);
      return;
    }
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

  /// Goes to where the next vertex or face starts; false at the end of the file.
  bool start() { return lines_ == Lines::mean_nothing ? cursor_.next_word() : cursor_.next_line(); }
  /// Whether a further value belongs to the vertex or face that is being read.
  bool goes_on() { return lines_ == Lines::one_each ? !cursor_.line_done() : cursor_.next_word(); }
  /// Whether it must end here.
  bool may_end() { return lines_ == Lines::mean_nothing || cursor_.line_done(); }

  void read_vertices() {
    const std::size_t normals = keyword_.normals ? 3 : 0, uvs = keyword_.uvs ? 2 : 0;
    const std::size_t least = 3 + normals + (keyword_.colours ? 3 : 0) + uvs;
    const std::size_t most = least + (keyword_.colours ? 1 : 0);
    const std::size_t expected = believable(vertices_, cursor_.bytes_left(), 2 * least);
    out_.positions.reserve(expected);
    if (keyword_.normals) out_.normals.reserve(expected);
    if (keyword_.uvs) out_.uvs.reserve(expected);

    std::size_t undeclared = 0;  // colour values of each vertex although there is no C
    std::array<double, 3 + 3 + 4 + 2> row{};
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      if (!start())
        cursor_.fail_here("cut off: the header promises {} vertices, found {}", vertices_, i);
      std::size_t found = 0;
      const std::size_t needed = lines_ == Lines::mean_nothing ? most : least;
      for (; found < needed && goes_on(); ++found)
        row[found] = cursor_.number() + 0.0;  // -0 becomes 0
      const bool optional_colour = lines_ == Lines::one_each && !keyword_.uvs;
      const std::size_t further = keyword_.colours ? most : optional_colour ? least + 4 : least;
      for (; found >= least && found < further && !may_end(); ++found)
        row[found] = cursor_.number() + 0.0;
      if (i == 0 && !keyword_.colours && (found == least + 3 || found == least + 4))
        undeclared = found - least;
      const bool fits = keyword_.colours ? found >= least : found == least + undeclared;
      const bool below_0 =
          fits && undeclared > 0 && *std::min_element(row.begin() + least, row.begin() + found) < 0;
      if (!fits || below_0 || !may_end())
        cursor_.fail_here("vertex {} must have {} values, found {}", i, least,
                          found < least ? "fewer" : "more");
      add_vertex(row, 3 + normals, found - uvs, undeclared > 0);
    }
  }

  /// Its colour's values run from `begin` to `end`, where uv follows.
  void add_vertex(const std::array<double, 12>& row, std::size_t begin, std::size_t end,
                  bool undeclared) {
    out_.positions.push_back({row[0], row[1], row[2]});
    if (keyword_.normals) out_.normals.push_back(to_mesh_floats({row[3], row[4], row[5]}));
    if (keyword_.uvs) out_.uvs.push_back({to_mesh_float(row[end]), to_mesh_float(row[end + 1])});
    if (!keyword_.colours && !undeclared) return;
    MeshColor color{0, 0, 0, k_no_alpha};
    for (std::size_t i = begin; i < end; ++i)
      color[i - begin] = to_mesh_float(row[i]);
    out_.colors.push_back(color);
  }

  void read_faces() {
    constexpr std::size_t k_most_colour_values = 4;
    out_.face_ends.reserve(believable(faces_, cursor_.bytes_left(), 2));
    bool coloured = false;
    for (std::uint64_t i = 0; i < faces_; ++i) {
      if (!start()) cursor_.fail_here("cut off: the header promises {} faces, found {}", faces_, i);
      const std::int64_t corners = cursor_.integer();
      if (corners < 0) cursor_.fail_here("face {} has {} corners", i, corners);
      for (std::int64_t c = 0; c < corners; ++c) {
        if (!goes_on()) cursor_.fail_here("face {} must have {} corners, found {}", i, corners, c);
        out_.corners.push_back(cursor_.index());
      }
      out_.face_ends.push_back(out_.corners.size());
      MeshColor color{1, 1, 1, k_no_alpha};
      std::size_t values = 0;
      for (; values < k_most_colour_values && !may_end(); ++values)
        color[values] = to_mesh_float(cursor_.number());
      if (!may_end())
        cursor_.fail_here("face {} has more than {} corners and a colour", i, corners);
      // One value is a number in a table of colours that no file holds.
      const bool is_colour = values >= 3;
      if (is_colour && !coloured) {
        coloured = true;
        out_.face_colors.assign(out_.face_ends.size() - 1, k_missing_color);
      }
      if (coloured) out_.face_colors.push_back(is_colour ? color : k_missing_color);
    }
    out_.missing.colors = fill_missing_colors(out_.face_colors);
  }

  /// One further line may stand there, if it is no face.
  void read_end() {
    if (!start()) return;
    cursor_.line_done();  // passes blanks
    const std::size_t bytes = cursor_.bytes_left();
    LineCursor line = cursor_;
    if (lines_ == Lines::mean_nothing || may_be_face(line) || cursor_.next_line())
      line.fail_here("text behind the last face the header promises");
    out_.trailing_bytes = bytes;
  }

  static bool may_be_face(LineCursor line) {
    std::vector<std::int64_t> numbers;
    while (!line.line_done()) {
      const std::string_view word = line.word();
      std::int64_t value = 0;
      const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (code != std::errc() || end != word.data() + word.size()) break;
      numbers.push_back(value);
    }
    return numbers.size() > 1 && numbers[0] > 0 &&
           static_cast<std::uint64_t>(numbers[0]) < numbers.size();
  }

  LineCursor cursor_;
  OffKeyword keyword_;
  Lines lines_ = Lines::one_each;
  std::uint64_t vertices_ = 0, faces_ = 0;
  Polygons out_;
};

/// Whether a file without a keyword can be one: a line of two or three counts, and then a line that
/// begins with a number.
bool begins_with_counts(LineCursor cursor) {
  std::size_t counts = 0;
  for (; !cursor.line_done(); ++counts) {
    const std::string_view word = cursor.word();
    if (word.find_first_not_of("0123456789") != word.npos) return false;
  }
  if (counts < 2 || counts > 3 || !cursor.next_line()) return false;
  cursor.line_done();  // passes blanks
  return parse_number(cursor.rest()).size > 0;
}

bool is_off(std::string_view bytes) {
  LineCursor cursor("", bytes, 1, '#');
  if (!cursor.next_line()) return false;
  LineCursor words = cursor;
  return parse_keyword(words.word()).has_value() || begins_with_counts(cursor);
}

Polygons read_off(std::string_view bytes, const std::string& name) {
  return OffReader(bytes, name).read();
}

}  // namespace

extern const MeshFormat k_off_format;
const MeshFormat k_off_format{
    "OFF", ".off", "normals, uvs and colours of vertices, colours of faces",
    [](std::string_view bytes, const std::string&) { return is_off(bytes); }, read_off};

}  // namespace ds

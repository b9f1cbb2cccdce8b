// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/base/file_names.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mesh_text.h"
#include "tracer/scene/mesh_topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// 3D Systems' STL, "StereoLithography Interface Specification" (1989), both forms:
//
//   text   = {"solid" [NAME] EOL {facet} "endsolid" [NAME] EOL}          words in any case
//   facet  = "facet" ["normal" NX NY NZ] "outer loop" {"vertex" X Y Z} "endloop" "endfacet"
//   binary = 80 bytes of anything, uint32 COUNT, COUNT times
//            float32 NX NY NZ, 3 times float32 X Y Z, uint16 ATTRIBUTE         little endian
//
// A facet's corners are places, not indices: corners of one place become one vertex, in the order in
// which they first occur. Its normal is that of its corners and not read; where it is to be kept, there
// is none ("flat" gives the same). Programs put colours into ATTRIBUTE in two ways that contradict each
// other: those that are not 0 are counted, and not read. What has the size that COUNT says is binary,
// even if its 80 bytes begin with "solid".

namespace ds {
namespace {

constexpr std::size_t k_header = 80, k_body = k_header + 4, k_facet = 50;

template <typename T>
T little_endian(const char* bytes) {
  std::array<unsigned char, sizeof(T)> raw{};
  std::copy_n(bytes, sizeof(T), raw.begin());
  if constexpr (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

std::uint64_t count_of(std::string_view bytes) {
  return little_endian<std::uint32_t>(bytes.data() + k_header);
}

bool has_binary_size(std::string_view bytes) {
  if (bytes.size() < k_body) return false;
  const std::uint64_t count = count_of(bytes);
  return count > 0 && bytes.size() == k_body + count * k_facet;
}

bool is_word(std::string_view found, std::string_view wanted) {
  return std::equal(found.begin(), found.end(), wanted.begin(), wanted.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

/// Whether there is a 0 where it would be in the header and the count of a binary file: in the count,
/// as long as that is below 2^24.
bool begins_as_binary(std::string_view bytes) {
  return bytes.size() >= k_body && bytes.substr(0, k_body).find('\0') != bytes.npos;
}

bool is_text(std::string_view bytes) {
  LineCursor cursor("", bytes, 1, '\0');
  return !begins_as_binary(bytes) && cursor.next_line() && is_word(cursor.word(), "solid");
}

/// Makes one vertex of the corners of one place. `corners` holds their places alone.
void weld_corners(Polygons& out, const std::vector<Vec3d>& corners, const std::string& name) {
  constexpr std::size_t k_most_corners = std::size_t{1} << 31U;
  if (corners.size() > k_most_corners)
    fail(ErrorKind::asset, "{}: at most {} corners can be used, got {}", name, k_most_corners,
         corners.size());
  const std::vector<std::uint32_t> first = weld(corners);
  std::vector<std::uint32_t> vertex_of(corners.size());
  out.corners.reserve(corners.size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (first[c] == c) {
      vertex_of[c] = static_cast<std::uint32_t>(out.positions.size());
      out.positions.push_back(corners[c]);
    }
    out.corners.push_back(vertex_of[first[c]]);
  }
}

Polygons read_binary(std::string_view bytes, const std::string& name) {
  const std::uint64_t count = count_of(bytes), found = (bytes.size() - k_body) / k_facet;
  if (found < count)
    fail(ErrorKind::asset, "{}: cut off: the header promises {} facets, found {}", name, count,
         found);
  Polygons out;
  std::vector<Vec3d> corners;
  corners.reserve(3 * count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* const facet = bytes.data() + k_body + i * k_facet;
    for (std::size_t c = 1; c <= 3; ++c) {
      const auto at = [&](std::size_t axis) {
        return double{little_endian<float>(facet + 4 * (3 * c + axis))} + 0.0;  // -0 becomes 0
      };
      corners.push_back({at(0), at(1), at(2)});
    }
    out.face_ends.push_back(corners.size());
    if (little_endian<std::uint16_t>(facet + 48) != 0) ++out.unused.attributes;
  }
  weld_corners(out, corners, name);
  out.trailing_bytes = bytes.size() - k_body - count * k_facet;
  return out;
}

class StlTextReader {
 public:
  StlTextReader(std::string_view bytes, const std::string& name)
      : name_(name), cursor_(name, bytes, 1, '\0') {}

  Polygons read() {
    while (cursor_.next_line())
      read_solid();
    weld_corners(out_, corners_, name_);
    return std::move(out_);
  }

 private:
  void read_solid() {
    take("solid");
    cursor_.rest_of_line();
    for (;;) {
      const std::string_view word = next("facet or endsolid");
      if (is_word(word, "endsolid")) break;
      if (!is_word(word, "facet")) refuse("facet or endsolid", word);
      read_facet();
    }
    cursor_.rest_of_line();
  }

  void read_facet() {
    std::string_view word = next("normal or outer");
    if (is_word(word, "normal")) {
      for (int i = 0; i < 3; ++i)
        next("a number");  // whatever it is: programs write "-nan(ind)"
      word = next("outer");
    }
    if (!is_word(word, "outer")) refuse("outer", word);
    take("loop");
    while (!is_word(word = next("vertex or endloop"), "endloop")) {
      if (!is_word(word, "vertex")) refuse("vertex or endloop", word);
      const double x = read_number(), y = read_number(), z = read_number();
      corners_.push_back({x, y, z});
    }
    take("endfacet");
    out_.face_ends.push_back(corners_.size());
  }

  double read_number() {
    if (!cursor_.next_word()) cursor_.fail_here("cut off: wanted a number");
    return cursor_.number() + 0.0;  // -0 becomes 0
  }

  std::string_view next(const char* wanted) {
    if (!cursor_.next_word()) cursor_.fail_here("cut off: wanted {}", wanted);
    return cursor_.word();
  }

  void take(const char* wanted) {
    const std::string_view word = next(wanted);
    if (!is_word(word, wanted)) refuse(wanted, word);
  }

  [[noreturn]] void refuse(const char* wanted, std::string_view word) {
    cursor_.fail_here("wanted {}, found \"{}\"", wanted, printable(word));
  }

  std::string name_;
  LineCursor cursor_;
  Polygons out_;
  std::vector<Vec3d> corners_;
};

/// What neither its size nor its first word tells is so by its name: a header may be anything.
bool is_stl(std::string_view bytes, const std::string& file) {
  return has_binary_size(bytes) || is_text(bytes) ||
         (has_ending(file, ".stl") && begins_as_binary(bytes));
}

Polygons read_stl(std::string_view bytes, const std::string& name) {
  return !has_binary_size(bytes) && is_text(bytes) ? StlTextReader(bytes, name).read()
                                                   : read_binary(bytes, name);
}

}  // namespace

extern const MeshFormat k_stl_format;
const MeshFormat k_stl_format{"STL", ".stl", "nothing: corners of one place become one vertex",
                              is_stl, read_stl};

}  // namespace ds

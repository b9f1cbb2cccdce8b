// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/base/file_names.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mesh_text.h"
#include "tracer/scene/mtl_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

// The text form of Wavefront's OBJ ("Advanced Visualizer Manual", appendix B1). A line is
//
//   vertex  = "v" X Y Z [W]  |  "v" X Y Z R G B [A]         a colour, as many programs write it
//   uv      = "vt" U [V [W]]
//   normal  = "vn" X Y Z
//   face    = ("f" | "fo") {CORNER}
//   CORNER  = V ["/" [VT] ["/" [VN]]]         counted from 1, or with a minus back from the last so far
//
// or of a kind that says nothing of a surface's shape: names of objects and groups, smoothing groups,
// and so on (k_without_shape). "#" begins a comment; "\" at a line's end joins it with the next, but in
// comments and names. W, the weight in curves and of 3D textures, is not used. A corner's VT, VN and
// colour go where those of a PLY file's go. "usemtl" NAME gives the faces behind it a material, of a file that a line
// "mtllib" FILE... names (mtl_reader.h). What is left out is counted: lines, points, curves, free-form surfaces, and lines of no known kind. An index may lead to a vertex that follows. No
// mark ends a file: what is cut off between two lines is not missed.

namespace ds {
namespace {

constexpr std::array<std::string_view, 6> k_shape{"v", "vt", "vn", "f", "fo", "usemtl"};
constexpr std::array<std::string_view, 28> k_without_shape{
    "g",     "o",   "s",        "mg",       "mtllib",     "maplib", "usemap",
    "bevel", "lod", "c_interp", "d_interp", "cstype",     "deg",    "bmat",
    "step",  "con", "ctech",    "stech",    "parm",       "trim",   "hole",
    "scrv",  "sp",  "end",      "res",      "shadow_obj", "vp",     "trace_obj"};
constexpr std::array<std::string_view, 5> k_lines{"l", "p", "curv", "curv2", "cdc"};
constexpr std::array<std::string_view, 4> k_surfaces{"surf", "bsp", "bzp", "cdp"};

template <std::size_t n>
bool is_in(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_obj_word(std::string_view word) {
  return is_in(k_shape, word) || is_in(k_without_shape, word) || is_in(k_lines, word) ||
         is_in(k_surfaces, word);
}

/// In the place of a corner's index of a uv or normal: none there, and none of that number.
constexpr std::uint32_t k_absent = 0xfffffffeU, k_bad = LineCursor::k_bad_index;

/// What corners say where their indices lead; nothing where none has one. Corners without one get 0, and
/// those whose index leads nowhere what is not finite.
template <typename Value>
std::vector<Value> values_of(const std::vector<std::uint32_t>& indices,
                             const std::vector<Value>& values, const Value& none,
                             std::uint64_t& missing) {
  std::vector<Value> found;
  if (std::all_of(indices.begin(), indices.end(), [](auto i) { return i == k_absent; }))
    return found;
  Value nowhere{};
  nowhere.x = std::numeric_limits<float>::quiet_NaN();
  found.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    if (i == k_absent) ++missing;
    found.push_back(i == k_absent ? none : i < values.size() ? values[i] : nowhere);
  }
  return found;
}

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name)
      : name_(name), cursor_(name, bytes, 1, '#', '\\') {}

  /// Values of mtllib lines.
  const std::vector<std::string>& libraries() const { return libraries_; }

  Polygons read() {
    while (cursor_.next_line())
      read_line(cursor_.word());
    refuse_indices_from_0();
    out_.counts_from_1 = true;
    out_.unused.materials = named_.size();
    out_.missing.colors = fill_missing_colors(out_.colors);
    out_.corner_uvs = values_of(corner_uvs_, uvs_, {}, out_.missing.uvs);
    std::uint64_t flat = 0;  // counted with the normals of no length, which they are
    out_.corner_normals = values_of(corner_normals_, normals_, {}, flat);
    return std::move(out_);
  }

 private:
  void read_line(std::string_view word) {
    if (word == "v")
      read_vertex();
    else if (word == "vt")
      read_uv();
    else if (word == "vn")
      read_normal();
    else if (word == "f" || word == "fo")
      read_face();
    else if (word == "usemtl" || word == "g" || word == "o" || word == "mtllib")
      read_name(word);
    else
      pass_over(word);
  }

  /// How many numbers the line holds; those that fit are in row_.
  std::size_t read_row() {
    std::size_t found = 0;
    for (; !cursor_.line_done(); ++found) {
      const double value = cursor_.number() + 0.0;  // -0 becomes 0
      if (found < row_.size()) row_[found] = value;
    }
    return found;
  }

  void read_vertex() {
    const std::size_t found = read_row();
    if (found != 3 && found != 4 && found != 6 && found != 7)
      cursor_.fail_here("a vertex must have 3, 4, 6 or 7 values, found {}", found);
    out_.positions.push_back({row_[0], row_[1], row_[2]});
    const bool coloured = found >= 6;
    if (coloured && out_.colors.empty())
      out_.colors.assign(out_.positions.size() - 1, k_missing_color);
    if (coloured)
      out_.colors.push_back({to_mesh_float(row_[3]), to_mesh_float(row_[4]), to_mesh_float(row_[5]),
                             found == 7 ? to_mesh_float(row_[6]) : k_no_alpha});
    else if (!out_.colors.empty())
      out_.colors.push_back(k_missing_color);
  }

  void read_uv() {
    const std::size_t found = read_row();
    if (found < 1 || found > 3)
      cursor_.fail_here("a texture vertex must have 1 to 3 values, found {}", found);
    uvs_.push_back({to_mesh_float(row_[0]), found > 1 ? to_mesh_float(row_[1]) : 0.0F});
  }

  void read_normal() {
    const std::size_t found = read_row();
    if (found != 3) cursor_.fail_here("a normal must have 3 values, found {}", found);
    normals_.push_back(to_mesh_floats({row_[0], row_[1], row_[2]}));
  }

  void read_face() {
    while (!cursor_.line_done())
      read_corner(cursor_.word());
    out_.face_ends.push_back(out_.corners.size());
    add_material();
  }

  /// Numbers follow from faces, as a usemtl without any names nothing that is shown.
  void add_material() {
    if (material_.empty()) {
      if (!out_.face_materials.empty()) out_.face_materials.push_back(0);
      return;
    }
    const auto [at, is_new] = materials_.try_emplace(
        material_, static_cast<std::uint32_t>(out_.material_names.size() + 1));
    if (is_new) out_.material_names.push_back(material_);
    out_.face_materials.resize(out_.face_ends.size() - 1, 0);
    out_.face_materials.push_back(at->second);
  }

  void read_corner(std::string_view word) {
    std::string_view rest = word;
    const std::optional<std::int64_t> vertex = take_index(rest);
    if (!vertex) refuse_corner(word);
    std::optional<std::int64_t> uv, normal;
    if (take_slash(rest)) {
      uv = take_index(rest);
      if (take_slash(rest)) normal = take_index(rest);
    }
    if (!rest.empty()) refuse_corner(word);
    least_ = std::min(least_, *vertex);
    most_ = std::max(most_, *vertex);
    out_.corners.push_back(index_of(*vertex, out_.positions.size()));
    corner_uvs_.push_back(uv ? index_of(*uv, uvs_.size()) : k_absent);
    corner_normals_.push_back(normal ? index_of(*normal, normals_.size()) : k_absent);
  }

  static bool take_slash(std::string_view& rest) {
    if (!rest.starts_with('/')) return false;
    rest.remove_prefix(1);
    return true;
  }

  /// Takes an integer off `rest`; nothing where it begins with none. One beyond 64 bits is the largest.
  static std::optional<std::int64_t> take_index(std::string_view& rest) {
    std::int64_t index = 0;
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), index);
    if (code == std::errc::invalid_argument) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    return code == std::errc() ? index : std::numeric_limits<std::int64_t>::max();
  }

  [[noreturn]] void refuse_corner(std::string_view word) {
    cursor_.fail_here("wanted a corner (V, V/VT, V//VN or V/VT/VN), found \"{}\"", printable(word));
  }

  /// From 0, of one counted from 1, or back from the `count` there are so far.
  static std::uint32_t index_of(std::int64_t written, std::size_t count) {
    const std::int64_t index =
        written < 0 ? static_cast<std::int64_t>(count) + written : written - 1;
    return index < 0 || index >= std::int64_t{k_absent} ? k_bad : static_cast<std::uint32_t>(index);
  }

  void read_name(std::string_view word) {
    const std::string_view name = cursor_.rest_of_line();
    if (word == "usemtl") material_ = name;
    if (word == "usemtl" && !name.empty()) named_.emplace(name);
    if (word == "mtllib" && !name.empty()) libraries_.emplace_back(name);
  }

  void pass_over(std::string_view word) {
    if (is_in(k_lines, word))
      ++out_.unused.elements;
    else if (is_in(k_surfaces, word))
      ++out_.unused.surfaces;
    else if (!is_in(k_without_shape, word))
      ++out_.unused.lines;
    while (!cursor_.line_done())
      cursor_.word();
  }

  /// Such a file loses the faces at its first vertex, and all others are of wrong vertices.
  void refuse_indices_from_0() const {
    if (least_ == 0 && most_ + 1 == static_cast<std::int64_t>(out_.positions.size()))
      fail(
          ErrorKind::asset,
          "{}: its faces' indices run from 0 to {}, one less than the number of its vertices: they "
          "must count from 1, add 1 to each",
          name_, most_);
  }

  std::string name_;
  LineCursor cursor_;
  Polygons out_;
  std::array<double, 7> row_{};
  std::vector<Vec2> uvs_;
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> corner_uvs_, corner_normals_;  ///< as long as out_.corners
  std::map<std::string, std::uint32_t, std::less<>> materials_;
  std::string material_;         ///< of the faces that follow
  std::set<std::string> named_;  ///< by lines usemtl, whether a face follows or not
  std::vector<std::string> libraries_;
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max(),
               most_ = -1;  ///< vertices' indices
};

/// By the first line that is no comment; a file of the format's ending, that is a text, may also begin
/// with what is no line of it.
bool is_obj(std::string_view bytes, const std::string& file) {
  LineCursor cursor("", bytes, 1, '#', '\\');
  if (!cursor.next_line()) return false;
  constexpr std::size_t k_looked_at = 4096;
  return is_obj_word(cursor.word()) ||
         (has_ending(file, ".obj") && bytes.substr(0, k_looked_at).find('\0') == bytes.npos);
}

Polygons read_obj(std::string_view bytes, const std::string& name) {
  return ObjReader(bytes, name).read();
}

std::vector<std::filesystem::path> obj_libraries(std::string_view bytes, const std::string& name) {
  ObjReader reader(bytes, name);
  reader.read();
  return mtl_files(reader.libraries(), name);
}

OwnMaterials obj_materials(std::string_view bytes, const std::string& name) {
  ObjReader reader(bytes, name);
  const Polygons polygons = reader.read();
  return mtl_materials(mtl_files(reader.libraries(), name), polygons.material_names);
}

}  // namespace

extern const MeshFormat k_obj_format;
const MeshFormat k_obj_format{
    "OBJ",
    ".obj",
    "uvs and normals of corners, colours of vertices behind their places; "
    "materials (usemtl) of .mtl files",
    is_obj,
    read_obj,
    nullptr,
    obj_materials,
    obj_libraries};

}  // namespace ds

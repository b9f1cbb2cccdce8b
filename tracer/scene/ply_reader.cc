// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh_polygons.h"
#include "tracer/scene/ply_header.h"
#include "tracer/scene/ply_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string_view>

// Of a PLY file's elements the reader takes
//   vertex     x y z, nx ny nz, a pair of texture coordinates under any of three names, and a colour
//              (red green blue, alpha; also r g b a and diffuse_red ...; alpha alone is of white)
//   face       vertex_index or vertex_indices; texcoord, two values for each of these; a colour
//   tristrips  vertex_index or vertex_indices, strips of triangles that an index below 0 ends
// in any order; everything else is passed over. Properties may have any order and type. Colours of
// unsigned char run to 255, of unsigned short to 65535; of another type see unit_colors.

namespace ds {
namespace {

/// What a vertex property is for. A row of values has one place for each but `skipped`.
enum Slot : std::size_t {
  k_x,
  k_y,
  k_z,
  k_nx,
  k_ny,
  k_nz,
  k_u,
  k_v,
  k_red,
  k_green,
  k_blue,
  k_alpha,
  k_slots,
  k_skipped = k_slots
};
using Row = std::array<double, k_slots>;

struct SlotName {
  std::string_view name;
  Slot slot;
};
constexpr std::array k_slot_names{
    SlotName{"x", k_x},         SlotName{"y", k_y},         SlotName{"z", k_z},
    SlotName{"nx", k_nx},       SlotName{"ny", k_ny},       SlotName{"nz", k_nz},
    SlotName{"u", k_u},         SlotName{"v", k_v},         SlotName{"s", k_u},
    SlotName{"t", k_v},         SlotName{"texture_u", k_u}, SlotName{"texture_v", k_v},
    SlotName{"texture_s", k_u}, SlotName{"texture_t", k_v},
};
constexpr std::array k_color_names{
    SlotName{"red", k_red},
    SlotName{"green", k_green},
    SlotName{"blue", k_blue},
    SlotName{"alpha", k_alpha},
    SlotName{"r", k_red},
    SlotName{"g", k_green},
    SlotName{"b", k_blue},
    SlotName{"a", k_alpha},
    SlotName{"diffuse_red", k_red},
    SlotName{"diffuse_green", k_green},
    SlotName{"diffuse_blue", k_blue},
};

struct VertexLayout {
  std::vector<Slot> slots;  ///< one a property of the element
  bool has_normals = false;
  bool has_uvs = false;
  bool has_colors = false;
};

Slot color_slot_of(const PlyProperty& property) {
  if (property.count_type) return k_skipped;
  for (const SlotName& known : k_color_names)
    if (known.name == property.name) return known.slot;
  return k_skipped;
}

Slot slot_of(const PlyProperty& property) {
  if (property.count_type) return k_skipped;
  for (const SlotName& known : k_slot_names)
    if (known.name == property.name) return known.slot;
  return color_slot_of(property);
}

/// Whether there is a whole colour, or an alpha alone, whose colour is white.
bool has_color(const std::array<int, k_slots + 1>& found) {
  const int colors = (found[k_red] > 0) + (found[k_green] > 0) + (found[k_blue] > 0);
  return colors == 3 || (colors == 0 && found[k_alpha] > 0);
}

/// What stands where a file says nothing: white, and as alpha what unit_colors takes for none.
Row first_row() {
  Row row{};
  row[k_red] = row[k_green] = row[k_blue] = 1;
  row[k_alpha] = -1;
  return row;
}

/// What a colour's value of that type is divided by.
double color_range(PlyType type) {
  return type == PlyType::uint8 ? 255 : type == PlyType::uint16 ? 65535 : 1;
}

MeshColor color_of(const Row& row) {
  return {to_mesh_float(row[k_red]), to_mesh_float(row[k_green]), to_mesh_float(row[k_blue]),
          to_mesh_float(row[k_alpha])};
}

VertexLayout layout_of(const PlyElement& vertex, const std::string& name) {
  VertexLayout layout;
  std::array<int, k_slots + 1> found{};
  for (const PlyProperty& property : vertex.properties) {
    Slot slot = slot_of(property);
    // A file may hold texture coordinates under two names; the first pair is taken.
    if (found[slot]++ > 0) slot = k_skipped;
    layout.slots.push_back(slot);
  }
  for (const Slot slot : {k_x, k_y, k_z})
    if (found[slot] == 0)
      fail(ErrorKind::asset, "{}:{}: element vertex must have numbers x, y and z, found no {}",
           name, vertex.line, k_slot_names[slot].name);
  layout.has_normals = found[k_nx] > 0 && found[k_ny] > 0 && found[k_nz] > 0;
  layout.has_uvs = found[k_u] > 0 && found[k_v] > 0;
  layout.has_colors = has_color(found);
  return layout;
}

/// The least bytes one of `element` takes in the file; in a text each value takes two.
std::size_t least_bytes(const PlyElement& element, PlyFormat format) {
  std::size_t least = 0;
  for (const PlyProperty& property : element.properties)
    least +=
        format == PlyFormat::ascii ? 2 : size_bytes(property.count_type.value_or(property.type));
  return std::max<std::size_t>(least, 1);
}

template <typename Source>
void skip_property(Source& source, const PlyProperty& property) {
  source.skip(property.type,
              property.count_type ? source.list_size(*property.count_type, property.type) : 1);
}

template <typename Source>
void read_vertices(Source& source, const PlyHeader& header, const PlyElement& element,
                   const std::string& name, Polygons& out) {
  const VertexLayout layout = layout_of(element, name);
  const std::size_t expected =
      believable(element.count, source.bytes_left(), least_bytes(element, header.format));
  out.positions.reserve(expected);
  if (layout.has_normals) out.normals.reserve(expected);
  if (layout.has_uvs) out.uvs.reserve(expected);
  if (layout.has_colors) out.colors.reserve(expected);

  Row row = first_row();
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const Slot slot = layout.slots[p];
      if (slot == k_skipped)
        skip_property(source, property);
      else
        row[slot] = source.number(property.type) / (slot < k_red ? 1 : color_range(property.type)) +
                    0.0;  // -0 becomes 0
    }
    source.end();
    out.positions.push_back({row[k_x], row[k_y], row[k_z]});
    if (layout.has_normals)
      out.normals.push_back(to_mesh_floats({row[k_nx], row[k_ny], row[k_nz]}));
    if (layout.has_uvs) out.uvs.push_back({to_mesh_float(row[k_u]), to_mesh_float(row[k_v])});
    if (layout.has_colors) out.colors.push_back(color_of(row));
  }
}

/// Which property of a face or strip lists its corners.
std::size_t corner_list_of(const PlyElement& face, const std::string& name) {
  const auto is_corner_list = [](const PlyProperty& property) {
    return property.count_type &&
           (property.name == "vertex_index" || property.name == "vertex_indices");
  };
  const auto& properties = face.properties;
  const auto found = std::find_if(properties.begin(), properties.end(), is_corner_list);
  if (found == properties.end())
    fail(ErrorKind::asset, "{}:{}: element {} must have a list vertex_index or vertex_indices",
         name, face.line, face.name);
  if (std::find_if(found + 1, properties.end(), is_corner_list) != properties.end())
    fail(ErrorKind::asset, "{}:{}: element {} has both vertex_index and vertex_indices", name,
         face.line, face.name);
  return static_cast<std::size_t>(found - properties.begin());
}

/// What is read of the faces of one element.
struct FaceLayout {
  std::size_t corners = 0;   ///< number of the property that lists them
  std::size_t uvs = 0;       ///< likewise; that of no property where there are none
  std::vector<Slot> colors;  ///< one a property; those of colours only where has_color
  bool has_colors = false;
};

FaceLayout face_layout_of(const PlyElement& face, const std::string& name) {
  FaceLayout layout;
  layout.corners = corner_list_of(face, name);
  layout.uvs = face.properties.size();
  std::array<int, k_slots + 1> found{};
  for (std::size_t p = 0; p < face.properties.size(); ++p) {
    const PlyProperty& property = face.properties[p];
    if (property.count_type && (property.name == "texcoord" || property.name == "texcoords"))
      layout.uvs = p;
    const Slot slot = color_slot_of(property);
    layout.colors.push_back(found[slot]++ > 0 ? k_skipped : slot);
  }
  layout.has_colors = has_color(found);
  if (!layout.has_colors) std::fill(layout.colors.begin(), layout.colors.end(), k_skipped);
  return layout;
}

/// The texture coordinates of the face whose corners have been or will be read; as many as the list
/// holds.
template <typename Source>
void read_corner_uvs(Source& source, const PlyProperty& property, std::vector<Vec2>& uvs) {
  const std::uint64_t values = source.list_size(*property.count_type, property.type);
  if (values % 2 != 0)
    source.fail_here(fmt::format("a face has {} values of {}", values, property.name));
  for (std::uint64_t i = 0; i < values / 2; ++i) {
    const float u = to_mesh_float(source.number(property.type));
    uvs.push_back({u, to_mesh_float(source.number(property.type))});
  }
}

template <typename Source>
void read_faces(Source& source, const PlyHeader& header, const PlyElement& element,
                const std::string& name, Polygons& out) {
  const FaceLayout layout = face_layout_of(element, name);
  const bool has_uvs = layout.uvs < element.properties.size();
  const std::size_t expected =
      believable(element.count, source.bytes_left(), least_bytes(element, header.format));
  out.face_ends.reserve(out.face_ends.size() + expected);
  // Strips may stand before.
  if (has_uvs) out.corner_uvs.resize(out.corners.size());
  if (layout.has_colors) out.face_colors.resize(out.face_ends.size(), {1, 1, 1, 1});
  bool any_uv = false;
  Row row = first_row();
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p == layout.corners) {
        const std::uint64_t corners = source.list_size(*property.count_type, property.type);
        for (std::uint64_t c = 0; c < corners; ++c)
          out.corners.push_back(source.index(property.type));
      } else if (p == layout.uvs) {
        read_corner_uvs(source, property, out.corner_uvs);
      } else if (layout.colors[p] != k_skipped) {
        row[layout.colors[p]] = source.number(property.type) / color_range(property.type) + 0.0;
      } else {
        skip_property(source, property);
      }
    }
    source.end();
    // Faces without a picture have an empty list.
    const std::size_t before = out.face_ends.empty() ? 0 : out.face_ends.back();
    any_uv = any_uv || out.corner_uvs.size() > before;
    if (has_uvs && out.corner_uvs.size() == before) out.corner_uvs.resize(out.corners.size());
    if (has_uvs && out.corner_uvs.size() != out.corners.size())
      source.fail_here(fmt::format("face {} has {} corners and {} pairs of {}", i,
                                   out.corners.size() - before, out.corner_uvs.size() - before,
                                   element.properties[layout.uvs].name));
    if (layout.has_colors) out.face_colors.push_back(color_of(row));
    out.face_ends.push_back(out.corners.size());
  }
  if (!any_uv) out.corner_uvs.clear();
}

/// The triangles of one strip: the second, fourth, ... run the other way round.
void add_strip(const std::vector<std::uint32_t>& strip, Polygons& out) {
  for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
    const std::size_t odd = i % 2;
    for (const std::size_t corner : {i + odd, i + 1 - odd, i + 2})
      out.corners.push_back(strip[corner]);
    out.face_ends.push_back(out.corners.size());
  }
}

template <typename Source>
void read_strips(Source& source, const PlyElement& element, const std::string& name,
                 Polygons& out) {
  const std::size_t corner_list = corner_list_of(element, name);
  std::vector<std::uint32_t> strip;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p != corner_list) {
        skip_property(source, property);
        continue;
      }
      strip.clear();
      const std::uint64_t corners = source.list_size(*property.count_type, property.type);
      for (std::uint64_t c = 0; c < corners; ++c) {
        strip.push_back(source.index(property.type));
        if (strip.back() != LineCursor::k_bad_index) continue;
        strip.pop_back();
        add_strip(strip, out);
        strip.clear();
      }
      add_strip(strip, out);
    }
    source.end();
  }
  // Corners and colours of faces say nothing of strips.
  if (!out.corner_uvs.empty()) out.corner_uvs.resize(out.corners.size());
  if (!out.face_colors.empty()) out.face_colors.resize(out.face_ends.size(), {1, 1, 1, 1});
}

template <typename Source>
void skip_element(Source& source, const PlyElement& element) {
  // Nothing stands in the file for an element without properties, whatever its count.
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (const PlyProperty& property : element.properties)
      skip_property(source, property);
    source.end();
  }
}

template <typename Source>
Polygons read_body(Source source, const PlyHeader& header, const std::string& name) {
  Polygons out;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex")
      read_vertices(source, header, element, name, out);
    else if (element.name == "face")
      read_faces(source, header, element, name, out);
    else if (element.name == "tristrips")
      read_strips(source, element, name, out);
    else
      skip_element(source, element);
  }
  out.trailing_bytes = source.finish();
  return out;
}

}  // namespace

Polygons read_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const auto has = [&](std::string_view wanted) {
    return std::any_of(header.elements.begin(), header.elements.end(),
                       [&](const PlyElement& element) { return element.name == wanted; });
  };
  if (!has("vertex")) fail(ErrorKind::asset, "{}: has no element vertex", name);
  if (!has("face") && !has("tristrips")) fail(ErrorKind::asset, "{}: has no element face", name);
  switch (header.format) {
    case PlyFormat::ascii:
      return read_body(PlyTextSource(bytes, header, name), header, name);
    case PlyFormat::binary_little_endian:
      return read_body(PlyBinarySource<std::endian::little>(bytes, header, name), header, name);
    case PlyFormat::binary_big_endian:
      return read_body(PlyBinarySource<std::endian::big>(bytes, header, name), header, name);
  }
  DS_ASSERT(false);
  return {};
}

}  // namespace ds

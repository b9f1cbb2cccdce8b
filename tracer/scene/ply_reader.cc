// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/ply_header.h"
#include "tracer/scene/ply_layout.h"
#include "tracer/scene/ply_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string_view>

// Of a PLY file's elements the reader takes
//   vertex     x y z, nx ny nz, a pair of texture coordinates (u v, s t, texture_u texture_v or
//              texture_s texture_t), and a colour (red green blue, alpha; also r g b a and
//              diffuse_red ...; alpha alone is of white)
//   face       vertex_index or vertex_indices; texcoord, two values for each of these; a colour
//   tristrips  vertex_index or vertex_indices, strips of triangles that an index below 0 ends
// in any order; everything else is passed over. Names may be in any case, properties in any order and
// of any type; of names that mean the same see ply_layout.h. Colours of unsigned char run to 255, of
// unsigned short to 65535; of another type see unit_colors.

namespace ds {
namespace {

void add(UnusedParts& to, const UnusedParts& more) {
  to.places += more.places;
  to.normals += more.normals;
  to.uvs += more.uvs;
  to.colors += more.colors;
}

/// What stands where a file says nothing: white, and as alpha what unit_colors takes for none.
PlyRow first_row() {
  PlyRow row{};
  row[k_red] = row[k_green] = row[k_blue] = 1;
  row[k_alpha] = static_cast<double>(k_no_alpha);
  return row;
}

MeshColor color_of(const PlyRow& row) {
  return {to_mesh_float(row[k_red]), to_mesh_float(row[k_green]), to_mesh_float(row[k_blue]),
          to_mesh_float(row[k_alpha])};
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
  const PlyLayout layout = vertex_layout(element, name);
  const bool has_normals = layout.has_kind(PlyKind::normal), has_uvs = layout.has_kind(PlyKind::uv);
  out.dark_colors = layout.dark_colors;
  add(out.unused, layout.unused);
  const std::size_t expected =
      believable(element.count, source.bytes_left(), least_bytes(element, header.format));
  out.positions.reserve(expected);
  if (has_normals) out.normals.reserve(expected);
  if (has_uvs) out.uvs.reserve(expected);
  if (layout.has_colors()) out.colors.reserve(expected);

  PlyRow row = first_row();
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const PlySlot slot = layout.slots[p];
      if (slot == k_skipped)
        skip_property(source, property);
      else
        row[slot] =
            source.number(property.type) / (slot < k_red ? 1 : ply_color_range(property.type)) +
            0.0;  // -0 becomes 0
    }
    source.end();
    out.positions.push_back({row[k_x], row[k_y], row[k_z]});
    if (has_normals) out.normals.push_back(to_mesh_floats({row[k_nx], row[k_ny], row[k_nz]}));
    if (has_uvs) out.uvs.push_back({to_mesh_float(row[k_u]), to_mesh_float(row[k_v])});
    if (layout.has_colors()) out.colors.push_back(color_of(row));
  }
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

/// For the corners, and the faces, that have none although others have.
void fill_uvs(Polygons& out) {
  out.missing.uvs += out.corners.size() - out.corner_uvs.size();
  out.corner_uvs.resize(out.corners.size());
}
void fill_colors(Polygons& out) {
  out.missing.colors += out.face_ends.size() - out.face_colors.size();
  out.face_colors.resize(out.face_ends.size(), {1, 1, 1, 1});
}

template <typename Source>
void read_faces(Source& source, const PlyHeader& header, const PlyElement& element,
                const std::string& name, Polygons& out) {
  const PlyFaceLayout layout = face_layout(element, name);
  const bool has_colors = layout.colors.has_colors();
  out.dark_face_colors = layout.colors.dark_colors;
  add(out.unused, layout.colors.unused);
  const bool has_uvs = layout.uvs < element.properties.size();
  const std::size_t expected =
      believable(element.count, source.bytes_left(), least_bytes(element, header.format));
  out.face_ends.reserve(out.face_ends.size() + expected);
  // Strips may stand before.
  if (has_uvs) fill_uvs(out);
  if (has_colors) fill_colors(out);
  bool any_uv = false;
  PlyRow row = first_row();
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
      } else if (layout.colors.slots[p] != k_skipped) {
        row[layout.colors.slots[p]] =
            source.number(property.type) / ply_color_range(property.type) + 0.0;
      } else {
        skip_property(source, property);
      }
    }
    source.end();
    // Faces without a picture have an empty list.
    const std::size_t before = out.face_ends.empty() ? 0 : out.face_ends.back();
    any_uv = any_uv || out.corner_uvs.size() > before;
    if (has_uvs && out.corner_uvs.size() == before) fill_uvs(out);
    if (has_uvs && out.corner_uvs.size() != out.corners.size())
      source.fail_here(fmt::format("face {} has {} corners and {} pairs of {}", i,
                                   out.corners.size() - before, out.corner_uvs.size() - before,
                                   element.properties[layout.uvs].name));
    if (has_colors) out.face_colors.push_back(color_of(row));
    out.face_ends.push_back(out.corners.size());
  }
  if (!any_uv) {
    out.corner_uvs.clear();
    out.missing.uvs = 0;
  }
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
  if (!out.corner_uvs.empty()) fill_uvs(out);
  if (!out.face_colors.empty()) fill_colors(out);
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
    if (is_ply_name(element.name, "vertex"))
      read_vertices(source, header, element, name, out);
    else if (is_ply_name(element.name, "face"))
      read_faces(source, header, element, name, out);
    else if (is_ply_name(element.name, "tristrips"))
      read_strips(source, element, name, out);
    else
      skip_element(source, element);
  }
  out.trailing_bytes = source.finish();
  return out;
}

Polygons read_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const auto has = [&](std::string_view wanted) {
    const auto count =
        std::count_if(header.elements.begin(), header.elements.end(),
                      [&](const PlyElement& element) { return is_ply_name(element.name, wanted); });
    if (count > 1) fail(ErrorKind::asset, "{}: has {} elements {}", name, count, wanted);
    return count == 1;
  };
  if (!has("vertex")) fail(ErrorKind::asset, "{}: has no element vertex", name);
  if (const bool face = has("face"), strips = has("tristrips"); !face && !strips)
    fail(ErrorKind::asset, "{}: has no element face", name);
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

}  // namespace

extern const MeshFormat k_ply_format;
const MeshFormat k_ply_format{
    "PLY", ".ply",
    "normals, uvs and colours of vertices, uvs of corners, colours of faces, strips of triangles",
    [](std::string_view bytes, const std::string&) { return is_ply(bytes); }, read_ply};

}  // namespace ds

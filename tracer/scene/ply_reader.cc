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

// Of a PLY file's elements the reader takes "vertex" (x y z, nx ny nz, and a pair of texture
// coordinates under any of three names) and "face" (vertex_index or vertex_indices), whichever
// comes first; everything else, texture coordinates per corner among it, is passed over. Properties
// may have any order and type.

namespace ds {
namespace {

/// What a vertex property is for. A row of values has one place for each but `skipped`.
enum Slot : std::size_t { k_x, k_y, k_z, k_nx, k_ny, k_nz, k_u, k_v, k_slots, k_skipped = k_slots };

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

struct VertexLayout {
  std::vector<Slot> slots;  ///< one a property of the element
  bool has_normals = false;
  bool has_uvs = false;
};

Slot slot_of(const PlyProperty& property) {
  if (property.count_type) return k_skipped;
  for (const SlotName& known : k_slot_names)
    if (known.name == property.name) return known.slot;
  return k_skipped;
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

  std::array<double, k_slots> row{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (layout.slots[p] == k_skipped)
        skip_property(source, property);
      else
        row[layout.slots[p]] = source.number(property.type) + 0.0;  // -0 becomes 0
    }
    source.end();
    out.positions.push_back({row[k_x], row[k_y], row[k_z]});
    if (layout.has_normals)
      out.normals.push_back(to_mesh_floats({row[k_nx], row[k_ny], row[k_nz]}));
    if (layout.has_uvs) out.uvs.push_back({to_mesh_float(row[k_u]), to_mesh_float(row[k_v])});
  }
}

/// Which property of a face lists its corners.
std::size_t corner_list_of(const PlyElement& face, const std::string& name) {
  const auto is_corner_list = [](const PlyProperty& property) {
    return property.count_type &&
           (property.name == "vertex_index" || property.name == "vertex_indices");
  };
  const auto& properties = face.properties;
  const auto found = std::find_if(properties.begin(), properties.end(), is_corner_list);
  if (found == properties.end())
    fail(ErrorKind::asset, "{}:{}: element face must have a list vertex_index or vertex_indices",
         name, face.line);
  if (std::find_if(found + 1, properties.end(), is_corner_list) != properties.end())
    fail(ErrorKind::asset, "{}:{}: element face has both vertex_index and vertex_indices", name,
         face.line);
  return static_cast<std::size_t>(found - properties.begin());
}

template <typename Source>
void read_faces(Source& source, const PlyHeader& header, const PlyElement& element,
                const std::string& name, Polygons& out) {
  const std::size_t corner_list = corner_list_of(element, name);
  const std::size_t expected =
      believable(element.count, source.bytes_left(), least_bytes(element, header.format));
  out.face_ends.reserve(expected);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    source.begin(element, i);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p != corner_list) {
        skip_property(source, property);
        continue;
      }
      const std::uint64_t corners = source.list_size(*property.count_type, property.type);
      for (std::uint64_t c = 0; c < corners; ++c)
        out.corners.push_back(source.index(property.type));
    }
    source.end();
    out.face_ends.push_back(out.corners.size());
  }
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
    else
      skip_element(source, element);
  }
  source.finish();
  return out;
}

}  // namespace

Polygons read_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  for (const std::string_view wanted : {"vertex", "face"})
    if (std::none_of(header.elements.begin(), header.elements.end(),
                     [&](const PlyElement& element) { return element.name == wanted; }))
      fail(ErrorKind::asset, "{}: has no element {}", name, wanted);
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

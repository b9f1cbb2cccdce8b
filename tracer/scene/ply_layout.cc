// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/ply_layout.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace ds {
namespace {

struct Family {
  PlyKind kind;
  PlySlot first;  ///< the others' follow
  std::array<std::string_view, 3> names;

  std::size_t size() const {
    return static_cast<std::size_t>(
        std::count_if(names.begin(), names.end(), [](auto name) { return !name.empty(); }));
  }
};
constexpr std::array k_color_families{
    Family{PlyKind::color, k_red, {"red", "green", "blue"}},
    Family{PlyKind::color, k_red, {"r", "g", "b"}},
    Family{PlyKind::color, k_red, {"diffuse_red", "diffuse_green", "diffuse_blue"}},
    Family{PlyKind::alpha, k_alpha, {"alpha", "", ""}},
    Family{PlyKind::alpha, k_alpha, {"a", "", ""}},
};
constexpr std::array k_vertex_families{
    Family{PlyKind::place, k_x, {"x", "y", "z"}},
    Family{PlyKind::normal, k_nx, {"nx", "ny", "nz"}},
    Family{PlyKind::uv, k_u, {"u", "v", ""}},
    Family{PlyKind::uv, k_u, {"s", "t", ""}},
    Family{PlyKind::uv, k_u, {"texture_u", "texture_v", ""}},
    Family{PlyKind::uv, k_u, {"texture_s", "texture_t", ""}},
};

/// Where the properties stand that have a family's names, and how many more have them too.
struct FoundFamily {
  const Family* family = nullptr;
  std::vector<std::size_t> at;
  std::size_t twice = 0;

  bool whole() const { return at.size() == family->size(); }
  std::size_t begin() const { return *std::min_element(at.begin(), at.end()); }
};

FoundFamily find_family(const PlyElement& element, const Family& family) {
  FoundFamily found{&family, {}, 0};
  for (std::size_t i = 0; i < family.size(); ++i) {
    bool is_first = true;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count_type || !is_ply_name(property.name, family.names[i])) continue;
      if (std::exchange(is_first, false))
        found.at.push_back(p);
      else
        ++found.twice;
    }
  }
  return found;
}

std::uint64_t& of_kind(UnusedParts& unused, PlyKind kind) {
  return kind == PlyKind::place    ? unused.places
         : kind == PlyKind::normal ? unused.normals
         : kind == PlyKind::uv     ? unused.uvs
                                   : unused.colors;
}

/// What stays 1/255 of such a type's range; 0 where the type tells no range.
float dark_color(PlyType type) {
  return ply_color_range(type) == 1 ? 0.0F : to_mesh_float(1.0 / 255);
}

/// Of the whole families of each kind the one that begins first in the file is read. `layout` has a
/// slot for each property.
void choose(const PlyElement& element, std::span<const Family> families, PlyLayout& layout) {
  std::array<std::optional<FoundFamily>, k_ply_kinds> chosen;
  for (const Family& family : families) {
    FoundFamily found = find_family(element, family);
    std::uint64_t& unused = of_kind(layout.unused, family.kind);
    unused += found.twice;
    if (!found.whole()) {
      // A single letter may mean anything.
      if (family.names[0].size() > 1) unused += found.at.size();
      continue;
    }
    auto& best = chosen[static_cast<std::size_t>(family.kind)];
    if (best) unused += family.size();
    if (!best || found.begin() < best->begin()) best = std::move(found);
  }
  for (const auto& found : chosen) {
    if (!found) continue;
    layout.has[static_cast<std::size_t>(found->family->kind)] = true;
    for (std::size_t i = 0; i < found->at.size(); ++i)
      layout.slots[found->at[i]] = static_cast<PlySlot>(found->family->first + i);
  }
  for (std::size_t p = 0; p < layout.slots.size(); ++p) {
    const PlySlot slot = layout.slots[p];
    if (slot < k_red || slot == k_skipped) continue;
    float& dark = slot == k_alpha ? layout.dark_colors.alpha : layout.dark_colors.color;
    dark = dark_color(element.properties[p].type);
  }
}

}  // namespace

bool is_ply_name(std::string_view found, std::string_view name) {
  return std::equal(found.begin(), found.end(), name.begin(), name.end(), [](char f, char n) {
    return (f >= 'A' && f <= 'Z' ? static_cast<char>(f - 'A' + 'a') : f) == n;
  });
}

double ply_color_range(PlyType type) {
  return type == PlyType::uint8 ? 255 : type == PlyType::uint16 ? 65535 : 1;
}

PlyLayout vertex_layout(const PlyElement& vertex, const std::string& name) {
  PlyLayout layout;
  layout.slots.assign(vertex.properties.size(), k_skipped);
  choose(vertex, k_vertex_families, layout);
  choose(vertex, k_color_families, layout);
  if (layout.has_kind(PlyKind::place)) return layout;
  for (const char* wanted : {"x", "y", "z"})
    if (std::none_of(vertex.properties.begin(), vertex.properties.end(), [&](const auto& property) {
          return !property.count_type && is_ply_name(property.name, wanted);
        }))
      fail(ErrorKind::asset, "{}:{}: element vertex must have numbers x, y and z, found no {}",
           name, vertex.line, wanted);
  DS_ASSERT(false);
  return layout;
}

std::size_t corner_list_of(const PlyElement& face, const std::string& name) {
  const auto is_corner_list = [](const PlyProperty& property) {
    return property.count_type && (is_ply_name(property.name, "vertex_index") ||
                                   is_ply_name(property.name, "vertex_indices"));
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

PlyFaceLayout face_layout(const PlyElement& face, const std::string& name) {
  PlyFaceLayout layout;
  layout.corners = corner_list_of(face, name);
  layout.uvs = face.properties.size();
  layout.colors.slots.assign(face.properties.size(), k_skipped);
  choose(face, k_color_families, layout.colors);
  for (std::size_t p = 0; p < face.properties.size(); ++p) {
    const PlyProperty& property = face.properties[p];
    if (!property.count_type ||
        !(is_ply_name(property.name, "texcoord") || is_ply_name(property.name, "texcoords")))
      continue;
    if (layout.uvs == face.properties.size())
      layout.uvs = p;
    else
      ++layout.colors.unused.uvs;
  }
  return layout;
}

}  // namespace ds

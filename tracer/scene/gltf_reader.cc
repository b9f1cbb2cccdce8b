// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/scene/gltf_file.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

// Khronos' glTF 2.0 (2021), as JSON (.gltf) and binary (.glb), parsed by tinygltf. Of the scene that the file begins
// with (its first where it says none; all nodes where it has no scene) the triangles, strips and fans of all nodes'
// meshes become one model, each vertex that they use with its POSITION, NORMAL, TEXCOORD_0 and COLOR_0 in the node's
// frame, metres, y up: recipes have models.up = "y" by default. Places are the numbers of the file where no node moves
// them; a node that mirrors turns its faces over. Attributes may be of any component type, sparse, and without a buffer.
// A buffer is in the file, in a data URI, or in a file beside this one or below its folder.
//
// Primitives' materials are gltf_materials.cc's. What is left out is counted: points and lines, joints and morph targets (such a mesh is shown as it is
// stored). Indices that lead nowhere lose their faces, as in other formats.

namespace ds {
namespace {

/// What a file of no bytes may make of nothing (an accessor without a buffer, a mesh in many nodes), and how many times
/// its own size.
constexpr std::size_t k_free_vertices = std::size_t{1} << 18U, k_vertices_a_byte = 32;
constexpr std::uint32_t k_bad = 0xffffffffU;

/// Column-major, as in the file.
using Matrix = std::array<double, 16>;
constexpr Matrix k_identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix product(const Matrix& a, const Matrix& b) {
  if (a == k_identity) return b;
  Matrix m{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k)
        m[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return m;
}

Matrix matrix_of(const tinygltf::Node& node) {
  Matrix m = k_identity;
  if (node.matrix.size() == 16) {
    std::copy(node.matrix.begin(), node.matrix.end(), m.begin());
    return m;
  }
  if (node.rotation.size() == 4) {
    const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2],
                 w = node.rotation[3];
    m = {1 - 2 * (y * y + z * z),
         2 * (x * y + w * z),
         2 * (x * z - w * y),
         0,
         2 * (x * y - w * z),
         1 - 2 * (x * x + z * z),
         2 * (y * z + w * x),
         0,
         2 * (x * z + w * y),
         2 * (y * z - w * x),
         1 - 2 * (x * x + y * y),
         0,
         0,
         0,
         0,
         1};
  }
  if (node.scale.size() == 3)
    for (std::size_t i = 0; i < 12; ++i)
      m[i] *= node.scale[i / 4];
  if (node.translation.size() == 3)
    std::copy(node.translation.begin(), node.translation.end(), m.begin() + 12);
  return m;
}

Vec3d moved(const Matrix& m, Vec3d p) {
  if (m == k_identity) return p;
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12] + 0.0,
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13] + 0.0,
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14] + 0.0};
}

/// The cofactors of its upper left: they turn normals, and where it mirrors, over. Its determinant's sign says whether.
struct NormalMatrix {
  std::array<Vec3d, 3> rows;
  bool mirrors = false;
};
NormalMatrix normal_matrix(const Matrix& m) {
  const Vec3d x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
  const Vec3d a = cross(y, z), b = cross(z, x), c = cross(x, y);
  const bool mirrors = dot(x, a) < 0;
  const double sign = mirrors ? -1 : 1;
  return {{Vec3d{a.x, b.x, c.x} * sign, Vec3d{a.y, b.y, c.y} * sign, Vec3d{a.z, b.z, c.z} * sign},
          mirrors};
}

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::string& name)
      : name_(name), file_(load_gltf(bytes, name)), model_(file_.model) {
    std::size_t size = bytes.size();
    for (const tinygltf::Buffer& buffer : model_.buffers)
      size += buffer.data.size();
    most_ = k_free_vertices + k_vertices_a_byte * size;
  }

  const GltfFile& file() const { return file_; }
  /// Of the file's materials, those that faces have, in the order of their numbers.
  const std::vector<int>& used_materials() const { return used_materials_; }

  Polygons read() {
    seen_.resize(model_.nodes.size());
    for (const int root : roots())
      walk(root);
    if (model_.nodes.empty())
      for (std::size_t i = 0; i < model_.meshes.size(); ++i)
        add_mesh(static_cast<int>(i), k_identity);
    if (out_.face_ends.empty()) fail(ErrorKind::asset, "{}: its scene has no faces", name_);
    out_.unused.materials = used_materials_.size();
    for (const int material : used_materials_)
      out_.material_names.push_back(model_.materials[static_cast<std::size_t>(material)].name);
    if (used_materials_.empty()) out_.face_materials.clear();
    out_.missing.colors = fill_missing_colors(out_.colors);
    out_.trailing_bytes = file_.trailing_bytes;
    return std::move(out_);
  }

 private:
  template <typename T>
  const T& at(const std::vector<T>& list, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      fail(ErrorKind::asset, "{}: wanted {} below {}, found {}", name_, what, list.size(), index);
    return list[static_cast<std::size_t>(index)];
  }

  std::vector<int> roots() const {
    if (!model_.scenes.empty())
      return at(model_.scenes, model_.defaultScene < 0 ? 0 : model_.defaultScene, "a scene").nodes;
    std::vector<bool> is_child(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children) {
        at(model_.nodes, child, "a node's child");
        is_child[static_cast<std::size_t>(child)] = true;
      }
    std::vector<int> found;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) found.push_back(static_cast<int>(i));
    return found;
  }

  /// The nodes below a root, parents first and in the file's order.
  void walk(int root) {
    struct Step {
      int node;
      Matrix parent;
    };
    std::vector<Step> stack{{root, k_identity}};
    while (!stack.empty()) {
      const Step step = stack.back();
      stack.pop_back();
      const tinygltf::Node& node = at(model_.nodes, step.node, "a node");
      if (seen_[static_cast<std::size_t>(step.node)])
        fail(ErrorKind::asset, "{}: node {} is below itself, or below two nodes", name_, step.node);
      seen_[static_cast<std::size_t>(step.node)] = true;
      const Matrix here = product(step.parent, matrix_of(node));
      if (node.mesh >= 0) {
        if (node.skin >= 0 || !at(model_.meshes, node.mesh, "a mesh").weights.empty() ||
            has_targets(node.mesh))
          ++out_.unused.poses;
        // A mesh with joints stands where they put it, not where its node is.
        add_mesh(node.mesh, node.skin >= 0 ? k_identity : here);
      }
      for (std::size_t i = node.children.size(); i-- > 0;)
        stack.push_back({node.children[i], here});
    }
  }

  bool has_targets(int mesh) const {
    const auto& primitives = at(model_.meshes, mesh, "a mesh").primitives;
    return std::any_of(primitives.begin(), primitives.end(),
                       [](const tinygltf::Primitive& p) { return !p.targets.empty(); });
  }

  void add_mesh(int mesh, const Matrix& matrix) {
    for (const tinygltf::Primitive& primitive : at(model_.meshes, mesh, "a mesh").primitives)
      add_primitive(primitive, matrix);
  }

  /// All elements of an accessor, so many numbers each, as shares of their type's range where they are normalised.
  struct Elements {
    std::vector<double> numbers;
    std::size_t width = 0, count = 0;
  };

  static double component(const unsigned char* bytes, int type, bool normalized) {
    const auto whole = [&]<typename T>(T value) {
      std::array<unsigned char, sizeof(T)> raw{};
      std::copy_n(bytes, sizeof(T), raw.begin());
      if constexpr (std::endian::native != std::endian::little)
        std::reverse(raw.begin(), raw.end());
      value = std::bit_cast<T>(raw);
      const double number = static_cast<double>(value);
      if (!normalized || !std::numeric_limits<T>::is_integer) return number;
      return std::max(number / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
    };
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return whole(std::int8_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return whole(std::uint8_t{});
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return whole(std::int16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return whole(std::uint16_t{});
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return whole(std::uint32_t{});
      default:
        return whole(float{});
    }
  }

  /// What a view has from `offset` on, if `count` elements of `size` bytes, `stride` apart, are there.
  const unsigned char* view_data(int index, std::size_t offset, std::size_t count, std::size_t size,
                                 std::size_t stride, const std::string& what) const {
    const tinygltf::BufferView& view = at(model_.bufferViews, index, "a buffer view");
    const std::vector<unsigned char>& data = at(model_.buffers, view.buffer, "a buffer").data;
    const bool view_fits =
        view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
    if (!view_fits)
      fail(ErrorKind::asset, "{}: buffer view {} ends at byte {} of a buffer of {}", name_, index,
           view.byteOffset + view.byteLength, data.size());
    const std::size_t room = offset <= view.byteLength ? view.byteLength - offset : 0;
    if (count > 0 && (room < size || (count - 1) > (room - size) / stride))
      fail(ErrorKind::asset,
           "{}: {} has {} elements of {} bytes, and its buffer view {} bytes for them", name_, what,
           count, size, room);
    return data.data() + view.byteOffset + offset;
  }

  static std::size_t component_size(int type) {
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type));
    return size == 1 || size == 2 || (size == 4 && type != TINYGLTF_COMPONENT_TYPE_INT)
               ? static_cast<std::size_t>(size)
               : 0;
  }

  /// Primitives often share them, and each is taken apart once.
  const Elements& elements(int index) {
    const auto known = elements_.find(index);
    if (known != elements_.end()) return known->second;
    return elements_.emplace(index, read_elements(index)).first->second;
  }

  Elements read_elements(int index) {
    const tinygltf::Accessor& accessor = at(model_.accessors, index, "an accessor");
    const std::string what = fmt::format("accessor {}", index);
    const std::size_t size = component_size(accessor.componentType);
    const int width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (size == 0 || width < 1 || width > 4)
      fail(ErrorKind::asset, "{}: {} is of no type that is read", name_, what);
    Elements all;
    all.width = static_cast<std::size_t>(width);
    all.count = accessor.count;
    const std::size_t whole = size * all.width;
    if (accessor.bufferView < 0) {
      if (all.count > k_free_vertices)
        fail(ErrorKind::asset, "{}: {} of {} elements is in no buffer view; at most {} may be so",
             name_, what, all.count, k_free_vertices);
      spend(all.count);
      all.numbers.resize(all.count * all.width);
    } else {
      const std::size_t stride = std::max(
          at(model_.bufferViews, accessor.bufferView, "a buffer view").byteStride, std::size_t{0});
      const std::size_t step = stride == 0 ? whole : stride;
      const unsigned char* bytes =
          view_data(accessor.bufferView, accessor.byteOffset, all.count, whole, step, what);
      spend(all.count);
      all.numbers.reserve(all.count * all.width);
      for (std::size_t i = 0; i < all.count; ++i)
        for (std::size_t k = 0; k < all.width; ++k)
          all.numbers.push_back(
              component(bytes + i * step + k * size, accessor.componentType, accessor.normalized));
    }
    if (accessor.sparse.isSparse) replace_sparse(accessor, what, all);
    return all;
  }

  void replace_sparse(const tinygltf::Accessor& accessor, const std::string& what,
                      Elements& all) const {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > all.count)
      fail(ErrorKind::asset, "{}: {} of {} elements replaces {}", name_, what, all.count,
           sparse.count);
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t index_size = component_size(sparse.indices.componentType);
    const std::size_t size = component_size(accessor.componentType), whole = size * all.width;
    if (index_size == 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
      fail(ErrorKind::asset, "{}: {} has sparse indices of no type that is read", name_, what);
    const unsigned char* indices =
        view_data(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                  count, index_size, index_size, what);
    const unsigned char* values =
        view_data(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                  count, whole, whole, what);
    for (std::size_t i = 0; i < count; ++i) {
      const double to = component(indices + i * index_size, sparse.indices.componentType, false);
      if (!(to >= 0) || to >= static_cast<double>(all.count))
        fail(ErrorKind::asset, "{}: {} of {} elements replaces its element {}", name_, what,
             all.count, to);
      for (std::size_t k = 0; k < all.width; ++k)
        all.numbers[static_cast<std::size_t>(to) * all.width + k] =
            component(values + i * whole + k * size, accessor.componentType, accessor.normalized);
    }
  }

  /// Of as many vertices as there are places; nothing where the primitive has none.
  const Elements* attribute(const tinygltf::Primitive& primitive, const char* semantic,
                            std::size_t least_width, std::size_t most_width, std::size_t vertices) {
    const auto found = primitive.attributes.find(semantic);
    if (found == primitive.attributes.end()) return nullptr;
    const Elements& all = elements(found->second);
    if (all.width < least_width || all.width > most_width || all.count < vertices)
      fail(ErrorKind::asset, "{}: {} has {} elements of {} numbers for {} places", name_, semantic,
           all.count, all.width, vertices);
    return &all;
  }

  /// A primitive's own vertices by what its indices call them: where each stands in out_, those that it uses.
  std::vector<std::uint32_t> vertex_of_;

  void add_primitive(const tinygltf::Primitive& primitive, const Matrix& matrix) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    const bool strip = mode == TINYGLTF_MODE_TRIANGLE_STRIP,
               fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (!strip && !fan && mode != TINYGLTF_MODE_TRIANGLES) {
      ++out_.unused.elements;
      return;
    }
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) return;  // as the format has it
    const std::uint32_t material = material_number(primitive.material);
    const Elements& places = elements(position->second);
    if (places.width != 3)
      fail(ErrorKind::asset, "{}: POSITION has {} numbers a place, not 3", name_, places.width);
    const Elements* const normals = attribute(primitive, "NORMAL", 3, 3, places.count);
    const Elements* const uvs = attribute(primitive, "TEXCOORD_0", 2, 2, places.count);
    const Elements* const colors = attribute(primitive, "COLOR_0", 3, 4, places.count);
    const Elements* const indices = primitive.indices >= 0 ? &elements(primitive.indices) : nullptr;
    if (indices != nullptr && indices->width != 1)
      fail(ErrorKind::asset, "{}: indices have {} numbers each, not 1", name_, indices->width);
    const std::size_t count = indices != nullptr ? indices->count : places.count;
    spend(count + places.count / 16);  // the latter for the table below
    vertex_of_.assign(places.count, k_bad);
    const NormalMatrix turn = normal_matrix(matrix);
    const auto vertex = [&](std::size_t corner) -> std::uint32_t {
      const double index =
          indices != nullptr ? indices->numbers[corner] : static_cast<double>(corner);
      if (!(index >= 0) || index >= static_cast<double>(places.count)) return k_bad;
      std::uint32_t& to = vertex_of_[static_cast<std::size_t>(index)];
      if (to == k_bad)
        to =
            add_vertex(static_cast<std::size_t>(index), places, normals, uvs, colors, matrix, turn);
      return to;
    };
    const auto face = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (turn.mirrors) std::swap(b, c);
      for (const std::size_t corner : {a, b, c})
        out_.corners.push_back(vertex(corner));
      out_.face_ends.push_back(out_.corners.size());
    };
    if (strip)
      for (std::size_t i = 0; i + 2 < count; ++i)
        face(i, i + 1 + i % 2, i + 2 - i % 2);
    else if (fan)
      for (std::size_t i = 1; i + 1 < count; ++i)
        face(i, i + 1, 0);
    else
      for (std::size_t i = 0; i + 2 < count; i += 3)
        face(i, i + 1, i + 2);
    if (!strip && !fan && count % 3 != 0)
      out_.face_ends.push_back(out_.corners.size());  // a face of too few corners
    out_.face_materials.resize(out_.face_ends.size(), material);
  }

  void spend(std::size_t count) {
    spent_ += std::min(count, most_ + 1);
    if (spent_ > most_)
      fail(ErrorKind::asset,
           "{}: it says more than {} numbers and corners, which is too many for a file of its size",
           name_, most_);
  }

  /// By the order in which primitives name them, from 1; 0 for none.
  std::uint32_t material_number(int material) {
    if (material < 0) return 0;
    at(model_.materials, material, "a material");
    const auto [number, is_new] = material_numbers_.try_emplace(
        material, static_cast<std::uint32_t>(used_materials_.size() + 1));
    if (is_new) used_materials_.push_back(material);
    return number->second;
  }

  std::uint32_t add_vertex(std::size_t i, const Elements& places, const Elements* normals,
                           const Elements* uvs, const Elements* colors, const Matrix& matrix,
                           const NormalMatrix& turn) {
    const std::size_t before = out_.positions.size();
    const double* p = places.numbers.data() + 3 * i;
    out_.positions.push_back(moved(matrix, {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}));
    if (normals) {
      const double* n = normals->numbers.data() + 3 * i;
      const Vec3d stored{n[0], n[1], n[2]};
      const Vec3d turned = matrix == k_identity
                               ? stored
                               : Vec3d{dot(turn.rows[0], stored), dot(turn.rows[1], stored),
                                       dot(turn.rows[2], stored)};
      out_.normals.resize(before);  // those without one have none: of length 0
      out_.normals.push_back(to_mesh_floats(turned));
    } else if (!out_.normals.empty()) {
      out_.normals.emplace_back();
    }
    if (uvs) {
      const double* uv = uvs->numbers.data() + 2 * i;
      if (out_.uvs.empty()) out_.missing.uvs += before;
      out_.uvs.resize(before);
      // The format's v runs down from the image's top, as our textures' do from theirs.
      out_.uvs.push_back({to_mesh_float(uv[0]), to_mesh_float(uv[1])});
    } else if (!out_.uvs.empty()) {
      ++out_.missing.uvs;
      out_.uvs.emplace_back();
    }
    if (colors) {
      const double* c = colors->numbers.data() + colors->width * i;
      out_.colors.resize(before, k_missing_color);
      out_.colors.push_back({to_mesh_float(c[0]), to_mesh_float(c[1]), to_mesh_float(c[2]),
                             colors->width == 4 ? to_mesh_float(c[3]) : 1.0f});
    } else if (!out_.colors.empty()) {
      out_.colors.push_back(k_missing_color);
    }
    return static_cast<std::uint32_t>(before);
  }

  std::string name_;
  GltfFile file_;
  const tinygltf::Model& model_;
  Polygons out_;
  std::map<int, Elements> elements_;  ///< by accessor
  std::vector<bool> seen_;
  std::map<int, std::uint32_t> material_numbers_;
  std::vector<int> used_materials_;
  std::size_t spent_ = 0, most_ = 0;
};

bool matches_gltf(std::string_view bytes, const std::string&) {
  return is_gltf(bytes);
}

Polygons read_gltf(std::string_view bytes, const std::string& name) {
  return GltfReader(bytes, name).read();
}

OwnMaterials read_materials(std::string_view bytes, const std::string& name) {
  GltfReader reader(bytes, name);
  reader.read();
  return gltf_materials(reader.file(), reader.used_materials(), name);
}

std::string read_image(std::string_view bytes, const std::string& name, int number) {
  const GltfFile file = load_gltf(bytes, name);
  return std::string(gltf_image(file.model, number, name));
}

}  // namespace

extern const MeshFormat k_gltf_format;
const MeshFormat k_gltf_format{
    "glTF",
    ".gltf .glb",
    "normals, uvs (TEXCOORD_0) and colours (COLOR_0) of vertices, materials; nodes' transforms are "
    "applied",
    matches_gltf,
    read_gltf,
    gltf_buffer_files,
    read_materials,
    nullptr,
    read_image};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/sdl_node.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ds {
namespace {

/// Of normals too, which an environment's meshes keep; what textures may read is not looked at.
void note_mended(Scene& scene, const std::filesystem::path& file, const MeshReport& report) {
  const MendedDamage damage = mended_damage(report);
  if (!damage.empty())
    scene.mended_meshes.push_back(fmt::format("{}: mended: {}", file.string(), to_text(damage)));
  if (report.zero_normals > 0)
    scene.mended_meshes.push_back(
        fmt::format("{}: {} of its normals are of length 0, and faces there flat", file.string(),
                    report.zero_normals));
  scene.lost_faces = scene.lost_faces || loses_faces(damage);
}

std::optional<FileMesh> read_ply(const SdlNode& node) {
  const std::optional<std::filesystem::path> file = node.file("ply");
  if (!file) return std::nullopt;
  try {
    Model model = read_model(*file, Winding::as_stored);
    note_mended(node.reader().scene, *file, model.report);
    return std::move(model.mesh);
  } catch (const Error& error) {
    if (node.reader().missed.insert(file->string()).second) node.error("ply", "{}", error.what());
    return std::nullopt;
  }
}

std::vector<SdlParameter> inlined_parameters() {
  return {{"vertices", SdlType::list, "", "x y z of each vertex"},
          {"faces", SdlType::list, "", "three indices of vertices a triangle, from 0"},
          {"normals", SdlType::list, "", "x y z a vertex"},
          {"uvs", SdlType::list, "", "u v a vertex"}};
}

std::vector<Vec3d> vectors(const std::vector<double>& v) {
  std::vector<Vec3d> result;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3)
    result.push_back({v[i], v[i + 1], v[i + 2]});
  return result;
}

void check_count(const SdlNode& node, std::string_view property, std::size_t found,
                 std::size_t vertices) {
  if (found != 0 && found != vertices)
    node.error(property, "wanted one for each of the {} vertices, found {}", vertices, found);
}

/// vertices, faces, normals and uvs as numbers in the file.
std::optional<FileMesh> read_inlined(const SdlNode& node) {
  FileMesh mesh;
  const auto positions = node.list("vertices", 3);
  const auto normals = node.list("normals", 3);
  const auto uvs = node.list("uvs", 2);
  const auto faces = node.list("faces", 3);
  if (!positions || !normals || !uvs || !faces) return std::nullopt;
  mesh.positions = vectors(*positions);
  for (const Vec3d normal : vectors(*normals))
    mesh.normals.push_back(to_float(normalized(normal)));
  for (std::size_t i = 0; i + 1 < uvs->size(); i += 2)
    mesh.uvs.push_back({static_cast<float>((*uvs)[i]), static_cast<float>((*uvs)[i + 1])});
  const std::size_t vertices = mesh.positions.size();
  check_count(node, "normals", mesh.normals.size(), vertices);
  check_count(node, "uvs", mesh.uvs.size(), vertices);

  for (const double index : *faces)
    if (!(index >= 0 && index < static_cast<double>(vertices) && std::floor(index) == index)) {
      node.error("faces", "wanted indices below {}, found {}", vertices, index);
      return std::nullopt;
    }
  for (std::size_t i = 0; i + 2 < faces->size(); i += 3)
    mesh.triangles.push_back({static_cast<std::uint32_t>((*faces)[i]),
                              static_cast<std::uint32_t>((*faces)[i + 1]),
                              static_cast<std::uint32_t>((*faces)[i + 2])});
  if (!mesh.triangles.empty()) return mesh;
  if (node.has("faces"))
    node.error("faces", "wanted at least one triangle, found none");
  else
    node.miss("faces");
  return std::nullopt;
}

/// Points by `m`, normals by its inverse transpose. A mirroring matrix turns the winding round, so
/// that the outside stays the outside.
void transform(FileMesh& mesh, const Mat4& m) {
  if (m == Mat4{}) return;
  for (Vec3d& position : mesh.positions)
    position = m.point(position);
  const Mat4 inverse = portable::inverse(m);
  for (Vec3& normal : mesh.normals)
    normal = to_float(portable::transform_normal(inverse, to_double(normal)));
  if (portable::determinant(m) < 0)
    for (auto& triangle : mesh.triangles)
      std::swap(triangle[1], triangle[2]);
}

std::optional<FileMesh> shape_of(const SdlNode& node) {
  const std::optional<std::string> name = node.text("shape");
  if (!name) return std::nullopt;
  node.refer(SdlKind::shape, *name);
  const auto found = node.reader().shapes.find(*name);
  if (found != node.reader().shapes.end()) return found->second;
  node.miss_reference("shape", SdlKind::shape, *name, node.reader().shapes);
  return std::nullopt;
}

std::optional<FileMesh> read_object_mesh(const SdlNode& node) {
  const int sources = int{node.has("ply")} + int{node.has("shape")} + int{node.has("vertices")};
  if (sources != 1) {
    constexpr std::string_view k_sources[] = {"ply", "shape", "vertices"};
    node.miss(sources == 0 ? std::span<const std::string_view>(k_sources)
                           : std::span<const std::string_view>(),
              fmt::format("wanted one of ply, shape and vertices, found {}", sources));
    return std::nullopt;
  }
  if (node.has("ply")) return read_ply(node);
  return node.has("shape") ? shape_of(node) : read_inlined(node);
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& triangle : mesh.triangles) {
    const Vec3d a = to_double(mesh.positions[triangle[0]]);
    const Vec3d b = to_double(mesh.positions[triangle[1]]);
    const Vec3d c = to_double(mesh.positions[triangle[2]]);
    area += 0.5 * length(cross(b - a, c - a));
  }
  return area;
}

/// Of a material that is the object's own, behind the name of the one that the file has.
std::string own_ending(const Object& object) {
  return "@" + object.name;
}

/// Emission by power depends on the area, so each object gets a material of its own. False where there is no area.
bool apply_power(SdlReader& reader, Object& object) {
  const auto power = reader.power_emissions.find(object.material);
  if (power == reader.power_emissions.end()) return true;
  const double area = area_of(object.mesh);
  if (!(area > 0)) return false;
  Material material = reader.scene.materials[static_cast<std::size_t>(object.material)];
  material.name += own_ending(object);
  const double factor = power->second.radiance_times_area / area;
  material.emission =
      scaled(reader, material.name + ".emission", material.emission, Vec3d{factor, factor, factor});
  object.material = static_cast<int>(reader.scene.materials.size());
  reader.scene.materials.push_back(std::move(material));
  return true;
}

int material_of(const SdlNode& node) {
  const std::optional<std::string> name = node.text("material");
  if (!name) {
    if (!node.has("material")) node.miss("material");
    return -1;
  }
  node.refer(SdlKind::material, *name);
  const auto found = node.reader().materials.find(*name);
  if (found != node.reader().materials.end()) return found->second;
  node.miss_reference("material", SdlKind::material, *name, node.reader().materials);
  return -1;
}

void read_object(const SdlNode& node) {
  Object object;
  object.name = node.name();
  object.material = material_of(node);
  object.camera_invisible = node.flag("camerainvisible");
  object.id = node.id("id");
  if (object.id == k_model_object_id)
    node.error("id", "{} is the id of the dataset's model, take another", object.id);
  std::optional<FileMesh> mesh = read_object_mesh(node);
  const Mat4 transformation = node.matrix("transformation");
  if (!mesh || object.material < 0) return;
  // What shines does so from the front, which may be meant to be the inner side.
  if (!node.reader().scene.materials[static_cast<std::size_t>(object.material)].emits)
    turn_outwards(*mesh);
  transform(*mesh, transformation);
  object.mesh = in_floats(std::move(*mesh));
  if (!apply_power(node.reader(), object))
    node.error("", "wanted an area above 0 for a material that emits by power");
  node.reader().scene.objects.push_back(std::move(object));
}

void read_shape(SdlNode node) {
  if (!node.read_type()) return;
  const std::string& type = node.type();
  if (type == "mesh" && !node.has("ply")) node.miss("ply");
  std::optional<FileMesh> mesh = type == "mesh" ? read_ply(node) : read_inlined(node);
  if (type == "mesh" && mesh) transform(*mesh, node.matrix("transformation"));
  if (mesh) node.reader().shapes.emplace(node.name(), std::move(*mesh));
}

SdlParameter ply_parameter() {
  return {"ply", SdlType::file, "", "a mesh file: " + mesh_format_names()};
}

}  // namespace

const SdlSection& shape_section() {
  static const SdlSection section{
      SdlKind::shape,
      "shapes",
      "Meshes that several objects may share.",
      "mesh",
      {},
      {{"mesh",
        "A mesh file.",
        {ply_parameter(),
         {"transformation", SdlType::matrix, "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
          "affine, applied to the points"}}},
       {"inlinedmesh", "A mesh in the file itself.", inlined_parameters()}}};
  return section;
}

const SdlSection& object_section() {
  static const SdlSection section{
      SdlKind::object,
      "objects",
      "What stands in an environment. An object has a material and one of `ply`, `shape` and "
      "`vertices`.",
      "",
      {},
      {{"", "",
        concatenated(
            {{{"material", SdlType::text, "", "the name of a material; must be given"},
              ply_parameter(),
              {"shape", SdlType::text, "", "the name of a shape"}},
             inlined_parameters(),
             {{"transformation", SdlType::matrix, "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
               "affine, to the world"},
              {"camerainvisible", SdlType::flag, "0", "seen in reflections and shadows only"},
              {"id",
               SdlType::id,
               "0",
               fmt::format("for the mask; {} is the dataset's model", k_model_object_id),
               {.least = 0, .most = 4294967295.0}}}})}}};
  return section;
}

void read_shapes(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.shapes"))
    read_shape(SdlNode(reader, SdlKind::shape, name));
}

void read_objects(SdlReader& reader) {
  for (const std::string& name : reader.properties.names_below("scene.objects"))
    read_object(SdlNode(reader, SdlKind::object, name));
}

void put_objects(SdlReader& reader, const Scene& read) {
  for (const Object& before : read.objects) {
    Object object = before;
    std::string name = read.materials[static_cast<std::size_t>(before.material)].name;
    auto material = reader.materials.find(name);
    if (const std::string ending = own_ending(before);
        material == reader.materials.end() && name.ends_with(ending))
      material = reader.materials.find(name.substr(0, name.size() - ending.size()));
    if (material == reader.materials.end())
      fail(ErrorKind::asset, "{}: the environment changed while the dataset was built",
           reader.folder.string());
    object.material = material->second;
    apply_power(reader, object);  // its area is what it was
    reader.scene.objects.push_back(std::move(object));
  }
}

}  // namespace ds

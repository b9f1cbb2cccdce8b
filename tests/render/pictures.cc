// SPDX-License-Identifier: Apache-2.0
#include "tests/render/pictures.h"

#include "tracer/base/hash.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <set>
#include <span>

namespace ds::pictures {
namespace {

constexpr double k_pi = std::numbers::pi;

Vec3 unit(Vec3 v) {
  return to_float(normalized(to_double(v)));
}

int add(Scene& scene, const NodeType& row, int type, Material material) {
  material.type = type;
  material.name = row.name;
  for (const InputType& input : row.inputs)
    material.inputs.push_back(
        {{input.default_value, input.default_value, input.default_value}, -1});
  for (const NumberType& number : row.numbers)
    material.numbers.push_back(number.default_value);
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

/// A texture image whose texels all differ.
Image coloured_texels() {
  Image image;
  image.width = 5;
  image.height = 3;
  for (int i = 0; i < 5 * 3 * 3; ++i)
    image.rgb.push_back(0.05f + 0.02f * static_cast<float>(i));
  return image;
}

EngineSettings small_engine() {
  EngineSettings engine;
  engine.width = 44;
  engine.height = 27;
  engine.spp = 4;
  engine.seed = 0x123456789abcdef0u;
  return engine;
}

Camera looking_at_origin() {
  Camera camera;
  camera.position = {0.3f, -2.6f, 1.5f};
  camera.focus_distance_m = 2.6;
  return camera;
}

/// Those that stand in one picture; each further one has a picture of its own, so that it changes no other.
constexpr std::array<std::string_view, 8> k_in_a_row = {"matte", "glossy2",    "metal2", "mirror",
                                                        "glass", "roughglass", "velvet", "mix"};

/// Things of these materials in a row, in front of a matte wall on a floor.
void add_materials(Scene& scene) {
  const int grey = add_matte(scene, {0.6f, 0.55f, 0.5f});
  add_object(scene, quad({0, 0, -0.35f}, {3, 0, 0}, {0, 3, 0}), grey);
  const std::size_t count = k_in_a_row.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int material = add_material(scene, k_in_a_row[i]);
    const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(count - 1)) * 0.5f;
    add_object(scene, sphere({x, 0, 0}, 0.24f, 9, i % 2 == 0), material,
               10 + static_cast<std::uint32_t>(i));
  }
}

/// A panel of every texture, each taking the one before it as its input where it has any.
void add_every_texture(Scene& scene) {
  scene.images.push_back(coloured_texels());
  TextureRef before{{0.8f, 0.6f, 0.4f}, -1};
  const std::size_t count = texture_types().size();
  for (std::size_t i = 0; i < count; ++i) {
    before = {{}, add_texture(scene, texture_types()[i].name, before)};
    const int material = add_material(scene, "matte");
    scene.materials.back().inputs[0] = before;
    const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(count - 1)) * 0.26f;
    Mesh panel = quad({x, 0.5f, 0.1f}, {0.12f, 0, 0.02f}, {0, 0.1f, 0.4f});
    panel.colors = {{0.9f, 0.1f, 0.1f, 0.2f},
                    {0.1f, 0.8f, 0.1f, 0.4f},
                    {0.1f, 0.1f, 0.7f, 0.6f},
                    {0.6f, 0.6f, 0, 0.8f}};
    add_object(scene, std::move(panel), material);
  }
}

void add_local_lights(Scene& scene) {
  scene.lights.push_back(point_light({-1, -1, 2}, {3, 2.5f, 2}));
  scene.lights.push_back(spot_light({1.5f, -1, 2}, {-0.6f, 0.4f, -0.8f}, 30, 20, {8, 9, 10}));
}

void add_far_lights(Scene& scene) {
  const int emitter = add_matte(scene, {0, 0, 0});
  scene.materials.back().emits = true;
  scene.materials.back().emission.constant = {4, 3, 2};
  add_object(scene, quad({0, -0.5f, 1.6f}, {0.3f, 0, 0}, {0, -0.2f, 0}), emitter);
  scene.images.push_back(small_sky());
  scene.lights.push_back(image_light(static_cast<int>(scene.images.size()) - 1));
  scene.lights.push_back(sun_light({0.3f, -0.5f, 0.8f}, 1.0, {900, 800, 700}));
  scene.lights.push_back(constant_light({0.1f, 0.1f, 0.15f}));
}

void add_other_materials(std::vector<Picture>& pictures) {
  for (const NodeType& type : material_types()) {
    if (std::ranges::find(k_in_a_row, type.name) != k_in_a_row.end()) continue;
    Scene scene;
    add_object(scene, quad({0, 0, -0.35f}, {3, 0, 0}, {0, 3, 0}),
               add_matte(scene, {0.6f, 0.55f, 0.5f}));
    const int material = add_material(scene, type.name);
    make_seen(scene, material);
    if (find_input(type, "anisotropic") >= 0)
      set_input(scene, material, "anisotropic", {0.6f, 0.6f, 0.6f});
    add_object(scene, sphere({-0.4f, 0, 0}, 0.34f, 9, true), material, k_model_object_id);
    add_object(scene, sphere({0.4f, 0, 0}, 0.34f, 9, false), material);
    add_local_lights(scene);
    scene.lights.push_back(constant_light({0.2f, 0.25f, 0.3f}));
    pictures.push_back({fmt::format("material-{}", type.kernel_prefix), scene, looking_at_origin(),
                        small_engine()});
  }
}

/// A picture for each light that stands in neither scene, so that one more changes no other.
void add_other_lights(std::vector<Picture>& pictures, std::initializer_list<const Scene*> with) {
  std::set<int> there{make_light("mesh").type};
  for (const Scene* other : with)
    for (const Light& light : other->lights)
      there.insert(light.type);
  for (std::size_t i = 0; i < light_types().size(); ++i) {
    if (there.contains(static_cast<int>(i))) continue;
    const std::string_view prefix = light_types()[i].kernel_prefix;
    Scene scene;
    const int glossy = add_material(scene, "glossy2");
    add_object(scene, quad({0, 0, -0.35f}, {3, 0, 0}, {0, 3, 0}), glossy);
    add_object(scene, sphere({0, 0, 0.2f}, 0.5f, 9, true), glossy);
    add_light(scene, prefix);
    pictures.push_back(
        {fmt::format("light-{}", prefix), scene, looking_at_origin(), small_engine()});
  }
}

}  // namespace

Mesh quad(Vec3 centre, Vec3 half_u, Vec3 half_v) {
  Mesh mesh;
  mesh.positions = {centre - half_u - half_v, centre + half_u - half_v, centre + half_u + half_v,
                    centre - half_u + half_v};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh box(Vec3 c, Vec3 h) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {c.x + (i & 1u ? h.x : -h.x), c.y + (i & 2u ? h.y : -h.y), c.z + (i & 4u ? h.z : -h.z)});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh inside_out(Mesh mesh) {
  for (auto& triangle : mesh.triangles)
    std::swap(triangle[1], triangle[2]);
  for (Vec3& normal : mesh.normals)
    normal = -normal;
  return mesh;
}

Mesh sphere(Vec3 centre, float radius, int rings, bool smooth) {
  Mesh mesh;
  const int around = 2 * rings;
  const auto at = [&](int ring, int i) {
    return static_cast<std::uint32_t>(ring * around + i % around);
  };
  for (int ring = 0; ring <= rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double polar = k_pi * ring / rings;
      const double azimuth = 2 * k_pi * i / around;
      const double sine = ring == 0 || ring == rings ? 0.0 : std::sin(polar);
      const Vec3 d =
          to_float(Vec3d{sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(polar)});
      mesh.positions.push_back(centre + d * radius);
      if (smooth) mesh.normals.push_back(unit(d));
      mesh.uvs.push_back({static_cast<float>(i) / static_cast<float>(around),
                          static_cast<float>(ring) / static_cast<float>(rings)});
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      if (ring > 0) mesh.triangles.push_back({at(ring, i), at(ring + 1, i), at(ring, i + 1)});
      if (ring + 1 < rings)
        mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1)});
    }
  return mesh;
}

int add_material(Scene& scene, std::string_view type) {
  const int row = find_type(material_types(), type);
  Material material;
  if (type == "mix") material.children[0] = 0, material.children[1] = 1;
  return add(scene, material_types()[static_cast<std::size_t>(row)], row, material);
}

int add_matte(Scene& scene, Vec3 kd) {
  const int material = add_material(scene, "matte");
  set_input(scene, material, "kd", kd);
  return material;
}

float seen_value(const NodeType& type, std::size_t input) {
  const InputType& row = type.inputs[input];
  const NumberRange range = row.told.range;
  const bool unseen = row.default_value == 0 && range.least == 0 && range.most == 1 &&
                      row.name != "anisotropic";  // whose axes a test would have to know
  return unseen ? 0.2f + 0.1f * static_cast<float>(input % 7) : row.default_value;
}

void make_seen(Scene& scene, int material) {
  Material& m = scene.materials[static_cast<std::size_t>(material)];
  const NodeType& type = material_types()[static_cast<std::size_t>(m.type)];
  for (std::size_t i = 0; i < type.inputs.size(); ++i) {
    const float value = seen_value(type, i);
    m.inputs[i] = {{value, value, value}, -1};
  }
}

void set_input(Scene& scene, int material, std::string_view name, Vec3 value) {
  Material& m = scene.materials[static_cast<std::size_t>(material)];
  const int input = find_input(material_types()[static_cast<std::size_t>(m.type)], name);
  m.inputs.at(static_cast<std::size_t>(input)) = {value, -1};
}

void add_object(Scene& scene, Mesh mesh, int material, std::uint32_t id) {
  Object object;
  object.mesh = std::move(mesh);
  object.material = material;
  object.id = id;
  scene.objects.push_back(std::move(object));
}

int add_texture(Scene& scene, std::string_view type, TextureRef first) {
  Texture texture;
  texture.type = find_type(texture_types(), type);
  const NodeType& row = texture_types()[static_cast<std::size_t>(texture.type)];
  texture.name = row.name;
  for (const InputType& input : row.inputs)
    texture.inputs.push_back({{input.default_value, input.default_value, input.default_value}, -1});
  for (TextureRef& input : texture.inputs)
    if (input.texture < 0) {
      input = first;
      break;
    }
  for (const NumberType& number : row.numbers)
    texture.numbers.push_back(number.default_value);
  for (std::size_t i = 0; i < 3; ++i)
    texture.world_to_texture.m[5 * i] = 9;
  if (type == "imagemap") texture.image = 0;
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

Light point_light(Vec3 position, Vec3 intensity) {
  Light light = make_light("point");
  set_light_value(light, "position", position);
  light.color = intensity;
  return light;
}

Light spot_light(Vec3 position, Vec3 direction, double outer_deg, double inner_deg,
                 Vec3 intensity) {
  Light light = make_light("spot");
  light.color = intensity;
  set_light_value(light, "position", position);
  set_light_value(light, "direction", unit(direction));
  *light_value(light, "cos_total") = static_cast<float>(std::cos(outer_deg * k_pi / 180));
  *light_value(light, "cos_falloff") = static_cast<float>(std::cos(inner_deg * k_pi / 180));
  return light;
}

Light sun_light(Vec3 direction, double radius_deg, Vec3 radiance) {
  Light light = make_light("sun");
  light.color = radiance;
  set_light_value(light, "direction", unit(direction));
  *light_value(light, "cos_total") = static_cast<float>(std::cos(radius_deg * k_pi / 180));
  return light;
}

Light constant_light(Vec3 radiance) {
  Light light = make_light("constant_infinite");
  light.color = radiance;
  return light;
}

Light image_light(int image) {
  Light light = make_light("infinite");
  light.color = {1, 1, 1};
  light.image = image;
  return light;
}

Light light_of_table(std::string_view prefix) {
  Light light = make_light(prefix);
  light.color = {3, 2.5f, 2};
  for (const LightInput& input : type_of(light).host.inputs) {
    if (input.value == LightValue::point) set_light_value(light, input.name, {-1, -1, 2});
    if (input.value == LightValue::direction)
      set_light_value(light, input.name, unit({0.3f, 0.5f, -0.8f}));
    if (input.value == LightValue::number)
      *light_value(light, input.name) = std::stof(std::string(input.default_value));
  }
  return light;
}

void add_light(Scene& scene, std::string_view prefix) {
  if (prefix == "spot") {
    scene.lights.push_back(spot_light({1, -1, 2}, {-0.45f, 0.4f, -0.8f}, 30, 20, {8, 9, 10}));
  } else if (prefix == "sun") {
    scene.lights.push_back(sun_light({0.3f, -0.5f, 0.8f}, 1.0, {900, 800, 700}));
  } else if (prefix == "infinite") {
    scene.images.push_back(small_sky());
    scene.lights.push_back(image_light(static_cast<int>(scene.images.size()) - 1));
  } else if (prefix == "mesh") {
    const int emitter = add_matte(scene, {0, 0, 0});
    scene.materials.back().emits = true;
    scene.materials.back().emission.constant = {4, 3, 2};
    add_object(scene, quad({0, -0.5f, 1.2f}, {0.3f, 0, 0}, {0, -0.2f, 0}), emitter);
  } else {
    scene.lights.push_back(light_of_table(prefix));
  }
}

Image small_sky() {
  Image image;
  image.width = 19;
  image.height = 9;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const float base = 0.2f + 0.1f * static_cast<float>((row * 7 + column * 3) % 5);
      const float value = row == 2 && column == 13 ? 1000 * base : base;
      image.rgb.insert(image.rgb.end(), {value, 0.9f * value, 0.8f * value});
    }
  return image;
}

std::vector<Picture> all_effects() {
  std::vector<Picture> pictures;
  Scene materials;
  add_materials(materials);
  add_local_lights(materials);
  pictures.push_back({"materials", materials, looking_at_origin(), small_engine()});
  Scene textures;
  add_every_texture(textures);
  add_far_lights(textures);
  pictures.push_back({"textures", textures, looking_at_origin(), small_engine()});
  add_other_lights(pictures, {&materials, &textures});
  add_other_materials(pictures);
  Scene everything;
  add_materials(everything);
  add_every_texture(everything);
  add_local_lights(everything);
  add_far_lights(everything);
  everything.objects.back().camera_invisible = true;  // the emitter
  for (Object& object : everything.objects)
    if (object.id >= 10) object.id = k_model_object_id;  // every material's sphere
  Camera lens = looking_at_origin();
  lens.lens_radius_m = 0.05;
  pictures.push_back({"everything", everything, lens, small_engine()});
  return pictures;
}

TracerOptions tracer_options() {
  TracerOptions options;
  options.cache_folder = DS_TEST_PROGRAMS;
  return options;
}

Film trace(const Picture& picture, const TracerOptions& options) {
  Tracer tracer(options);
  tracer.set_scene(picture.scene);
  return tracer.trace(picture.camera, picture.engine);
}

std::string film_hash(const Film& film) {
  return hash_bytes(std::as_bytes(std::span(film.rgb))).hex();
}

std::uint64_t wide_seed(std::uint64_t number) {
  // splitmix64 (Steele, Lea and Flood 2014).
  std::uint64_t z = number * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

namespace {

/// `values[k]` of picture k.
Estimate estimate_of(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  Estimate e;
  for (const double v : values)
    e.mean += v / n;
  double squares = 0;
  for (const double v : values)
    squares += (v - e.mean) * (v - e.mean);
  e.error = std::sqrt(squares / (n - 1) / n);
  return e;
}

std::vector<Film> independent_films(const Picture& picture, int pictures,
                                    std::uint64_t first_seed) {
  Tracer tracer(tracer_options());
  tracer.set_scene(picture.scene);
  EngineSettings engine = picture.engine;
  std::vector<Film> films;
  for (int i = 0; i < pictures; ++i) {
    engine.seed = wide_seed(first_seed + static_cast<std::uint64_t>(i));
    films.push_back(tracer.trace(picture.camera, engine));
  }
  return films;
}

}  // namespace

Estimate estimate(const Picture& picture, int pictures, std::uint64_t first_seed) {
  std::vector<double> means;
  for (const Film& film : independent_films(picture, pictures, first_seed)) {
    double sum = 0;
    for (const float v : film.rgb)
      sum += double{v};
    means.push_back(sum / static_cast<double>(film.rgb.size()));
  }
  return estimate_of(means);
}

std::vector<Estimate> estimate_pixels(const Picture& picture, int pictures,
                                      std::uint64_t first_seed) {
  const std::vector<Film> films = independent_films(picture, pictures, first_seed);
  std::vector<Estimate> result;
  std::vector<double> values(films.size());
  for (std::size_t pixel = 0; pixel < films[0].rgb.size() / 3; ++pixel) {
    for (std::size_t k = 0; k < films.size(); ++k)
      values[k] = double{films[k].rgb[3 * pixel]};
    result.push_back(estimate_of(values));
  }
  return result;
}

}  // namespace ds::pictures

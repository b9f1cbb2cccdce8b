// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/type_tables.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Small scenes for tests of whole pictures, and what is asked of the pictures.
namespace ds::pictures {

/// Two triangles, counter-clockwise seen from the side that cross(half_u, half_v) points to; (u, v)
/// runs from (0, 0) at centre - half_u - half_v to (1, 1).
Mesh quad(Vec3 centre, Vec3 half_u, Vec3 half_v);
/// Twelve triangles seen from outside, flat.
Mesh box(Vec3 centre, Vec3 half);
/// Corners in the other order.
Mesh inside_out(Mesh mesh);
/// `rings` bands from pole to pole, twice as many around; smooth: normals from the centre.
Mesh sphere(Vec3 centre, float radius, int rings, bool smooth);

/// A material of this SDL type with the table's defaults; its index. A mix takes the scene's first
/// two materials.
int add_material(Scene& scene, std::string_view type);
int add_matte(Scene& scene, Vec3 kd);
/// Sets input `name` of a material to a constant.
void set_input(Scene& scene, int material, std::string_view name, Vec3 value);
/// What a test gives an input that it says nothing of: the table's default, but of a share that defaults to 0 so much
/// that it is seen.
float seen_value(const NodeType& type, std::size_t input);
/// Sets all inputs to that.
void make_seen(Scene& scene, int material);
void add_object(Scene& scene, Mesh mesh, int material, std::uint32_t id = 2);
/// A texture of this SDL type with the table's defaults, whose colour inputs take `first`; its
/// index.
int add_texture(Scene& scene, std::string_view type, TextureRef first);

Light point_light(Vec3 position, Vec3 intensity);
Light spot_light(Vec3 position, Vec3 direction, double outer_deg, double inner_deg, Vec3 intensity);
Light sun_light(Vec3 direction, double radius_deg, Vec3 radiance);
Light constant_light(Vec3 radiance);
Light image_light(int image);
/// A light that is all in its type's table, with the table's numbers, from about above.
Light light_of_table(std::string_view prefix);
/// A light of this kernel prefix, and what it needs; it shines on the origin.
void add_light(Scene& scene, std::string_view prefix);
/// A lat-long picture with one texel a thousand times as bright as the rest; odd width and height.
Image small_sky();

struct Picture {
  std::string name;
  Scene scene;
  Camera camera;
  EngineSettings engine;
};

/// Pictures that together hold every material and texture of the tables, every kind of light, the
/// lens, and an object that the camera does not see.
std::vector<Picture> all_effects();

/// Default options with a cache of programs that all tests share.
TracerOptions tracer_options();
Film trace(const Picture& picture, const TracerOptions& options = tracer_options());
/// Of the film's bits, as 32 hexadecimal digits.
std::string film_hash(const Film& film);

/// A seed whose bits have nothing in common with those of other numbers' seeds.
std::uint64_t wide_seed(std::uint64_t number);

/// Mean over independent pictures of the mean of all pixels and channels, and that mean's standard
/// error.
struct Estimate {
  double mean = 0, error = 0;
};
Estimate estimate(const Picture& picture, int pictures, std::uint64_t first_seed = 1);
/// By pixel: channel 0.
std::vector<Estimate> estimate_pixels(const Picture& picture, int pictures,
                                      std::uint64_t first_seed = 1);

}  // namespace ds::pictures

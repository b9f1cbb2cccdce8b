// SPDX-License-Identifier: Apache-2.0
// NaN, infinity and 3e38 anywhere: an error that names the place, or a mended mesh; never a black
// picture. (LuxCore shows an almost black one for a single vertex of 3e38, and takes indices out of
// range without a word.)
#include "tests/hard/everywhere.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/render/view.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace ds {
namespace {

using pictures::Picture;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

Picture lit_sphere() {
  Picture p = hard::deep_picture(8, 16);
  const int grey = pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f});
  pictures::add_object(p.scene, pictures::sphere({}, 1, 12, true), grey);
  p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
  p.camera.position = {0.6, -1.7, 0.8};
  p.camera.fov_deg = 20;
  return p;
}

std::string error_of(const Picture& p) {
  try {
    hard::trace(p, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Indices that no list has.
const std::vector<float> k_no_index = {-2, 1000};

struct Spoiler {
  const char* name;
  std::function<void(Picture&, float)> spoil;
  const char* message;
  std::vector<float> values = {k_nan, k_infinity, -k_infinity};
};

std::vector<Spoiler> mesh_spoilers() {
  return {
      {"vertex",
       [](Picture& p, float x) { p.scene.objects[0].mesh.positions[7].y = x; },
       "vertex 7 must be finite and within 1e+18",
       {k_nan, k_infinity, -k_infinity, 3e38f, -2e18f}},
      {"normal", [](Picture& p, float x) { p.scene.objects[0].mesh.normals[5].z = x; },
       "normal 5 must be finite"},
      {"uv", [](Picture& p, float x) { p.scene.objects[0].mesh.uvs[3].x = x; },
       "uv 3 must be finite"},
      {"index",
       [](Picture& p, float) {
         p.scene.objects[0].mesh.triangles[9][1] =
             static_cast<std::uint32_t>(p.scene.objects[0].mesh.positions.size());
       },
       "a triangle's index must be below",
       {0}},
      {"object's material", [](Picture& p, float x) { p.scene.objects[0].material = int(x); },
       "its material must be one of 1, got", k_no_index},
  };
}

std::vector<Spoiler> material_spoilers() {
  return {
      {"material",
       [](Picture& p, float x) {
         pictures::set_input(p.scene, 0, "kd", {x, 0, 0});
       },
       "material matte: a value must be finite"},
      {"material's number",
       [](Picture& p, float x) {
         p.scene.materials[static_cast<std::size_t>(pictures::add_material(p.scene, "glossy2"))]
             .numbers.at(0) = x;
       },
       "material glossy2: a number must be finite"},
      {"mix",
       [](Picture& p, float x) {
         pictures::add_matte(p.scene, {1, 1, 1});
         pictures::set_input(p.scene, pictures::add_material(p.scene, "mix"), "amount", {x, x, x});
       },
       "material mix: a value must be finite"},
      {"part of a mix",
       [](Picture& p, float x) {
         pictures::add_matte(p.scene, {1, 1, 1});
         pictures::add_material(p.scene, "mix");
         p.scene.materials.back().children[1] = int(x);
       },
       "material mix: a part must be one of the 2 before it",
       {2, 3, -7}},
      {"emission",
       [](Picture& p, float x) {
         p.scene.materials[0].emits = true;
         p.scene.materials[0].emission.constant = {0, x, 0};
       },
       "emission must be finite and not negative",
       {k_nan, k_infinity, -1}},
      {"texture of an input",
       [](Picture& p, float x) { p.scene.materials[0].inputs[0].texture = int(x); },
       "material matte: an input's texture must be one of 0, got", k_no_index},
  };
}

/// Of a matte whose colour is the scale of a marble.
Texture& scale_of(Picture& p) {
  const int marble = pictures::add_texture(p.scene, "marble", {});
  p.scene.materials[0].inputs[0].texture =
      pictures::add_texture(p.scene, "scale", {{1, 1, 1}, marble});
  return p.scene.textures.back();
}

std::vector<Spoiler> texture_spoilers() {
  return {
      {"texture's constant", [](Picture& p, float x) { scale_of(p).inputs[1].constant.y = x; },
       "texture scale: a value must be finite"},
      {"texture's number",
       [](Picture& p, float x) {
         scale_of(p);
         p.scene.textures[0].numbers[2] = x;
       },
       "texture marble: a number must be finite"},
      {"texture's place",
       [](Picture& p, float x) { scale_of(p).world_to_texture.m[6] = double{x}; },
       "texture scale: its transformation must be finite"},
      {"texture's place beyond floats",
       [](Picture& p, float) { scale_of(p).world_to_texture.m[3] = -1e300; },
       "texture scale: its transformation must be finite and within the range of floats",
       {0}},
      {"texture's place in uv", [](Picture& p, float x) { scale_of(p).uv_transform[4] = x; },
       "texture scale: its transformation of uv must be finite"},
      {"texture of a texture", [](Picture& p, float x) { scale_of(p).inputs[0].texture = int(x); },
       "texture scale: an input's texture must be one of 1, got", k_no_index},
      {"texture's image", [](Picture& p, float x) { scale_of(p).image = int(x); },
       "texture scale: its image must be one of 0, got", k_no_index},
  };
}

Light& spot_of(Picture& p) {
  p.scene.lights.push_back(pictures::spot_light({0, 0, 3}, {0, 0, -1}, 30, 20, {1, 1, 1}));
  return p.scene.lights.back();
}

std::vector<Spoiler> light_spoilers() {
  return {
      {"sky",
       [](Picture& p, float x) { p.scene.lights[0].color.z = x; },
       "its colour must be finite and not negative",
       {k_nan, k_infinity, -1e-30f}},
      {"lamp",
       [](Picture& p, float x) {
         p.scene.lights.push_back(pictures::point_light({0, x, 3}, {1, 1, 1}));
       },
       "its position must be finite",
       {k_nan, k_infinity, 3e38f}},
      {"spot's axis", [](Picture& p, float x) { *light_value(spot_of(p), "direction") = x; },
       "its direction must be finite"},
      {"spot's outer cosine",
       [](Picture& p, float x) { *light_value(spot_of(p), "cos_total") = x; },
       "its cos_total must be finite"},
      {"spot's inner cosine",
       [](Picture& p, float x) { *light_value(spot_of(p), "cos_falloff") = x; },
       "its cos_falloff must be finite"},
      {"sun's radius",
       [](Picture& p, float x) {
         p.scene.lights.push_back(pictures::sun_light({0, 0, 1}, 0.3, {1, 1, 1}));
         *light_value(p.scene.lights.back(), "cos_total") = x;
       },
       "its cos_total must be finite"},
      {"texel",
       [](Picture& p, float x) {
         p.scene.images.push_back(pictures::small_sky());
         p.scene.images[0].rgb[100] = x;
         p.scene.images[0].made_from = "a test";
         p.scene.lights.push_back(pictures::image_light(0));
       },
       "image a test: texel 33 must be finite and not negative",
       {k_nan, k_infinity, -0.5f}},
      {"turn of a sky",
       [](Picture& p, float x) {
         p.scene.images.push_back(pictures::small_sky());
         p.scene.lights.push_back(pictures::image_light(0));
         p.scene.lights.back().light_to_world.m[5] = double{x};
       },
       "its transformation must be finite"},
      {"image of a sky",
       [](Picture& p, float x) { p.scene.lights.push_back(pictures::image_light(int(x))); },
       "its image must be one of 0, got", k_no_index},
  };
}

std::vector<Spoiler> camera_spoilers() {
  return {
      {"camera", [](Picture& p, float x) { p.camera.position.z = double{x}; },
       "a camera's position, target and up must be finite"},
      {"camera's target", [](Picture& p, float x) { p.camera.target.x = double{x}; },
       "a camera's position, target and up must be finite"},
      {"camera beyond floats",
       [](Picture& p, float) { p.camera.position.x = 1e300; },
       "a camera's position and target must be within 1e+18",
       {0}},
      {"field of view",
       [](Picture& p, float x) { p.camera.fov_deg = double{x}; },
       "a camera's fov_deg must be in (0, 180), got",
       {k_nan, k_infinity, -k_infinity, 0, 180}},
      {"lens",
       [](Picture& p, float x) { p.camera.lens_radius_m = double{x}; },
       "a camera's lens_radius_m must be finite and not negative, got",
       {k_nan, k_infinity, -1}},
      {"focus",
       [](Picture& p, float x) {
         p.camera.lens_radius_m = 0.01;
         p.camera.focus_distance_m = double{x};
       },
       "a camera's focus_distance_m must be finite and above 0, got",
       {k_nan, k_infinity, 0, -1}},
  };
}

TEST(Numbers, OneOutOfItsRangeAnywhereInASceneIsAnErrorThatSaysWhere) {
  EXPECT_EQ(error_of(lit_sphere()), "no error");
  for (const std::vector<Spoiler>& spoilers :
       {mesh_spoilers(), material_spoilers(), texture_spoilers(), light_spoilers(),
        camera_spoilers()})
    for (const Spoiler& spoiler : spoilers)
      for (const float value : spoiler.values) {
        Picture p = lit_sphere();
        spoiler.spoil(p, value);
        EXPECT_THAT(error_of(p), testing::HasSubstr(spoiler.message))
            << spoiler.name << " " << value;
      }
  // What failed leaves nothing behind.
  EXPECT_EQ(error_of(lit_sphere()), "no error");
}

/// A tetrahedron of corners 0 0 0, 1 0 0, 0 1 0, 0 0 1, and what else the file holds.
std::string tetra_and(const std::string& vertices, int vertex_count, const std::string& faces,
                      int face_count) {
  return "OFF\n" + std::to_string(4 + vertex_count) + " " + std::to_string(4 + face_count) +
         " 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + vertices + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n" +
         faces;
}

TEST(Numbers, AModelFileWithABadVertexOrIndexIsMended) {
  // Seen from the side that the slanted face is on, under a sky of 1: radiance 0.5.
  const auto expect_tetra = [](const std::string& file) {
    Picture p = hard::deep_picture(4, 16);
    p.name = file;
    NormaliseOptions as_it_is;
    as_it_is.up = UpAxis::z;
    as_it_is.size_m = 0;
    as_it_is.place_on_ground = false;
    as_it_is.centre = Centring::none;
    as_it_is.normals = Normals::flat;
    pictures::add_object(p.scene, normalise(parse_model(file, "m").mesh, as_it_is),
                         pictures::add_matte(p.scene, {0.5f, 0.5f, 0.5f}));
    p.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
    p.camera.position = {3, 3, 3};
    p.camera.target = {0.3, 0.3, 0.3};
    p.camera.fov_deg = 3;
    hard::everywhere(p,
                     [](const Film& film) { EXPECT_LT(hard::worst_difference(film, 0.5), 1e-6); });
  };
  for (const char* bad : {"3e38", "-3e38", "nan", "inf", "-inf", "1e400", "1e30"})
    expect_tetra(tetra_and("0 " + std::string(bad) + " 0\n", 1, "3 0 1 4\n4 0 1 2 4\n", 2));
  for (const char* face : {"3 0 1 4\n", "3 0 1 -1\n", "3 0 1 4294967295\n", "3 0 1 1e30\n"})
    expect_tetra(tetra_and("", 0, face, 1));
}

TEST(Numbers, WhatAnEnvironmentFileMultipliesOutOfRangeIsAnError) {
  // Each number is sound; their product is not.
  const TemporaryFolder folder;
  const std::string square =
      "scene.materials.a.type = matte\nscene.objects.s.vertices = -1 -1 0 1 -1 0 1 1 0\n"
      "scene.objects.s.faces = 0 1 2\nscene.objects.s.material = a\n";
  const auto error_of_file = [&](const std::string& text) {
    write_file_atomic(folder.path() / "environment.scn", square + text);
    Picture p = lit_sphere();
    try {
      p.scene = read_environment(folder.path());
      hard::trace(p, {});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error_of_file(""), "no error");
  EXPECT_THAT(error_of_file("scene.objects.s.transformation = 1e30 0 0 0 0 1e30 0 0 0 0 1e30 0 0 0 "
                            "0 1\n"),
              testing::HasSubstr("object s: vertex 0 must be finite and within 1e+18"));
  EXPECT_THAT(error_of_file("scene.lights.l.type = point\nscene.lights.l.gain = 1e30 1 1\n"
                            "scene.lights.l.color = 1e30 1 1\n"),
              testing::HasSubstr("light l: its colour must be finite"));
  EXPECT_THAT(error_of_file("scene.lights.l.type = point\nscene.lights.l.color = 0 0 0\n"
                            "scene.lights.l.power = 100\nscene.lights.l.efficiency = 10\n"),
              testing::HasSubstr("wanted a colour above 0 to normalise by"));
  EXPECT_THAT(error_of_file("scene.objects.t.vertices = 0 0 0 1 0 0 0 1 0\n"
                            "scene.objects.t.faces = 0 1 3\nscene.objects.t.material = a\n"),
              testing::HasSubstr("wanted indices below 3, found 3"));
}

}  // namespace
}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"
#include "tracer/base/vec.h"
#include "tracer/scene/mesh.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace ds {

/// The value of a material's or texture's input: a constant, or the output of a texture of the same
/// scene.
struct TextureRef {
  Vec3 constant;     ///< linear Rec.709; a scalar stands in all three
  int texture = -1;  ///< index into Scene::textures, or -1: constant
};

enum class ImageWrap { repeat, black, white, clamp };
enum class ImageFilter { nearest, linear };
enum class ImageUse { texture, light };
enum class ImageChannel { rgb, red, green, blue, alpha, mean, colored_mean };

/// An image file and how it is read. Pixels are loaded by tracer/render; row 0 is the top.
struct Image {
  std::filesystem::path file;
  /// Its number among the images that a model's file holds (own_materials.h); -1: the file is the image.
  int embedded = -1;
  /// linear = stored^gamma; 1 for HDR files (the reader refuses another value there).
  float gamma = 2.2f;
  /// Whole numbers are sRGB's (IEC 61966-2-1), whatever the gamma.
  bool srgb = false;
  float gain = 1.0f;
  ImageWrap wrap = ImageWrap::repeat;
  ImageFilter filter = ImageFilter::linear;
  ImageChannel channel = ImageChannel::rgb;
  ImageUse use = ImageUse::texture;
  Hash128 content;        ///< of the file's bytes, or of the pixels where the reader made them
  std::string made_from;  ///< what the reader made the pixels from, in words for `explain`; empty
                          ///< for a file
  int width = 0, height = 0;
  std::vector<float> rgb;  ///< width * height * 3, linear, after gamma and gain; filled by the
                           ///< reader for sky2 (empty file)
};

/// A node of a texture graph; inputs always have lower indices. Types, inputs and numbers:
/// scene/type_tables.h.
struct Texture {
  std::string name;
  int type = 0;                    ///< row of texture_types()
  std::vector<TextureRef> inputs;  ///< in the row's order
  std::vector<float> numbers;      ///< in the row's order
  Mat4 world_to_texture;           ///< 3D mappings: texture point = world_to_texture * world point
  /// 2D mappings: (s, t) = [a b c; d e f] (u, v, 1). (0, 0) is the image's top left corner, (1, 1)
  /// its bottom right; texel (i, j) has its centre at ((i + 0.5) / width, (j + 0.5) / height). As
  /// LuxCore.
  float uv_transform[6] = {1, 0, 0, 0, 1, 0};
  int image = -1;  ///< index into Scene::images (imagemap)
};

/// An input whose images' pixels alone tell whether it is physical (texture_bounds.h).
struct InputOfPixels {
  std::string subject;   ///< "m.mat:3: scene.materials.body.kd"
  std::string property;  ///< "kd"
  TextureRef value;
};

struct Material {
  std::string name;
  int type = 0;                    ///< row of material_types()
  std::vector<TextureRef> inputs;  ///< in the row's order
  std::vector<float> numbers;      ///< in the row's order
  int children[2] = {-1, -1};      ///< what it chooses among: indices lower than its own
  bool emits = false;
  /// Emitted radiance, W/(m^2 sr), all of LuxCore's gains applied. From the front only: the side on
  /// which the triangle's corners run counter-clockwise. As LuxCore.
  TextureRef emission;
  std::uint32_t id = 0;  ///< as in the file, 0 where it has none; moves no picture
  /// A line for each input out of its physical range ("m.mat:3: ...kd: wanted ..."). No part of any
  /// key.
  std::vector<std::string> unphysical;
  std::vector<InputOfPixels> of_pixels;
};

/// A light that is no mesh. Points and directions are in world space. "W" stands for whatever unit
/// the SDL file has: LuxCore's sun and sky are photometric (about 1e5 lm/m^2 on the ground).
///
/// Types and their values: scene/type_tables.h. point: `color` is radiant intensity, W/sr. spot:
/// that on the axis; LuxCore's intensity at the angle a from the axis is color * falloff(cos a) /
/// cos a (as if through a flat opening), falloff = clamp((cos a - cos_total) / (cos_falloff -
/// cos_total), 0, 1)^4; direction: the way it shines; cos_total: cosine beyond which there is no
/// light; cos_falloff > cos_total: where the falloff starts. sun: radiance of the uniform disc,
/// W/(m^2 sr); direction: towards it; cos_total: cosine of its angular radius. constant_infinite:
/// radiance. infinite: factor on the image, whose values are radiance.
struct Light {
  std::string name;
  int type = 0;  ///< row of light_types()
  Vec3 color;
  std::vector<float> values;  ///< of the row's inputs behind the colour, in its order
  int image = -1;  ///< infinite: lat-long image in Scene::images (sky2 makes one of its own, with
                   ///< an empty file name)
  /// infinite: orthogonal 3x3, no translation; it mirrors (determinant -1) for image files. In
  /// light space the image's row 0 is at +z and its middle column at +x, columns to its left
  /// towards +y: with azimuth = atan2(y, x) and polar angle = acos(z), u = 0.5 - azimuth / 2 pi and
  /// v = polar / pi. LuxCore has u = azimuth / 2 pi in its light space (measured: u = 0 at +x, 0.25
  /// at +y), which shows a panorama mirrored; the reader puts that mirror in here.
  Mat4 light_to_world;
  /// A hint for sampling: the image's lower half stays visible.
  bool upper_hemisphere_only = false;
};

struct Object {
  std::string name;
  Mesh mesh;  ///< in world space: transformations are applied by the reader; flat-shaded where it
              ///< has no normals
  int material = -1;
  /// Of each triangle, where they differ; else empty.
  std::vector<std::uint32_t> triangle_materials{};
  std::uint32_t id = 0;  ///< as in the file, 0 where it has none; never k_model_object_id there
  bool camera_invisible = false;
};

/// Tone mapping, LuxCore's film.imagepipeline. See render/develop.h for the formulas.
struct ToneMap {
  enum class Kind { linear, reinhard02, autolinear } kind = Kind::linear;
  float scale = 1;                                     ///< linear
  float prescale = 1, postscale = 1.2f, burn = 3.75f;  ///< reinhard02
  float gamma = 2.2f;
};

/// Everything a picture shows but its camera. Z up, metres, right-handed, linear Rec.709.
struct Scene {
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<Light> lights;
  ToneMap tone_map;
  /// Of a model's own materials (own_materials.h): which of `materials` each number in Mesh::materials means, -1
  /// for one that no triangle has; and materials_hash of the mesh that these are of.
  std::vector<int> own_materials{};
  Hash128 own_faces{};
  /// What was wrong with its objects' files, a line each; no part of a picture.
  std::vector<std::string> mended_meshes{};
  bool lost_faces = false;  ///< one of them did when it was read
  bool unlikely = false;    ///< something of its files, of which was warned, is hardly meant
};

/// A camera, with an optional thin lens.
struct Camera {
  int type = 0;  ///< row of camera_types(): perspective
  Vec3d position{0.252, 0, 0};
  Vec3d target{};
  Vec3d up{0, 0, 1};
  // One of these two, as the type says, is how much the longer image side shows:
  double fov_deg = 49;              ///< full angle; perspective: (0, 180)
  double extent_m = 0.23;           ///< metres, above 0
  double lens_radius_m = 0;         ///< 0: pinhole
  double focus_distance_m = 0.252;  ///< along the viewing axis, > 0
};

}  // namespace ds

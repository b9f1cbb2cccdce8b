// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"
#include "tracer/scene/sdl.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// The materials that a model's file gives its faces (materials.assign = "own"), as `disney` shows them: an OBJ file's
/// .mtl, a glTF file's metallic and roughness.
namespace ds {

/// An image that they show.
struct OwnImage {
  std::filesystem::path file;  ///< that is it, or holds it
  int embedded = -1;           ///< its number among those in the file; -1: the file is the image
  Hash128 content{};           ///< of the bytes of such a one

  bool operator==(const OwnImage&) const = default;
};

/// What a material says of one of disney's inputs: a factor, and what it multiplies.
struct OwnInput {
  Vec3 factor{1, 1, 1};  ///< linear; a scalar stands in all three
  int image = -1;        ///< of OwnMaterials::images, or -1: white
  ImageChannel channel = ImageChannel::rgb;
  bool srgb = false;
  ImageWrap wrap = ImageWrap::repeat;
  ImageFilter filter = ImageFilter::linear;
  std::array<float, 6> uv_transform{1, 0, 0, 0, 1, 0};  ///< as Texture's

  bool operator==(const OwnInput&) const = default;
};

struct OwnMaterial {
  std::string name;                        ///< as the file has it
  std::map<std::string, OwnInput> inputs;  ///< by disney's names; others are 0

  bool operator==(const OwnMaterial&) const = default;
};

struct OwnMaterials {
  /// In the order in which faces first name them, as Mesh::materials counts them from 1.
  std::vector<OwnMaterial> materials;
  OwnMaterial bare;       ///< what triangles show that have none
  bool has_bare = false;  ///< whether there are such
  Hash128 faces{};        ///< materials_hash of the mesh
  std::vector<OwnImage> images;
  /// What is not used, or was assumed, by a name of k_own_notes: how often.
  std::map<std::string, std::uint64_t> notes;

  bool operator==(const OwnMaterials&) const = default;
};

/// What may be said of a model's own materials, behind "some of their own materials ".
struct OwnNote {
  const char* name;
  const char* text;
};
inline constexpr const char* k_bare_faces = "bare_faces";
inline constexpr std::array k_own_notes{
    OwnNote{k_bare_faces,
            "are none: these faces show light grey or their vertices' colours, in glTF files the "
            "format's default, white metal"},
    OwnNote{"undefined", "are defined in no .mtl file that they name: these faces show light grey"},
    OwnNote{"emission", "shine, which is not shown"},
    OwnNote{"transparency", "are transparent, by alpha, dissolve or illum, and are shown opaque"},
    OwnNote{"normal_maps", "have normal, bump or displacement maps, which are not used"},
    OwnNote{"highlight_maps", "have maps of their highlights (map_Ks, map_Ns), which are not used"},
    OwnNote{"occlusion_maps", "have maps of occlusion, which is traced and not read"},
    OwnNote{"further_uvs", "have textures by a second set of uvs, which are not used"},
    OwnNote{"mirrored",
            "have textures that go on mirrored, or otherwise in u than in v: they are repeated"},
    OwnNote{"map_options", "have options of map_ lines that are not used"},
    OwnNote{"black_factor",
            "multiply a colour map by black, which programs write and do not mean: by white here"},
    OwnNote{"extensions",
            "have further properties (KHR_materials_ ..., Pc, Ps, aniso), which are not used"},
    OwnNote{"unknown_lines",
            "have lines in their .mtl files that begin with no word of the format"},
    OwnNote{"out_of_range",
            "have numbers outside of [0, 1], which are taken as the nearest inside"},
};
const OwnNote* own_note(std::string_view name);

/// What faces of most formats show that have no material.
OwnMaterial light_grey();
/// Its index in `materials.images`, where it is put if it is not there.
int image_number(OwnMaterials& materials, const OwnImage& image);

/// The files beside a model's own, in the order in which it names them, that its materials are in; images are none of
/// them. They need not be there. Throws as read_model.
std::vector<std::filesystem::path> own_material_files(const std::filesystem::path& model);

/// Throws Error(asset) where a file of own_material_files is not there or is none, and as read_model. Does not look for
/// images that are files.
OwnMaterials read_own_materials(const std::filesystem::path& model);

/// The bytes of an image that a model's file holds. Throws Error(asset) where it has none of that number.
std::string embedded_image(const std::filesystem::path& model, int number);

/// As text and back, for what is kept of a file that was read. Throws Error(io) for what own_materials_text did not
/// make.
std::string own_materials_text(const OwnMaterials& own);
OwnMaterials own_materials_from_text(std::string_view text);

/// As a scene of images, textures and materials for `compose`: number n with the id n, and behind all, where triangles
/// have none, what these show, with the id 0. `has_colors`: the mesh's own colours multiply the base colour. Asks
/// `content_of` for the hashes of images that are files, and throws what it throws.
Scene own_scene(const OwnMaterials& materials, bool has_colors, const ContentOf& content_of);

}  // namespace ds

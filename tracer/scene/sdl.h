// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ds {

/// Hash of a file's bytes, from whoever may know it without reading them. Throws as content_hash.
using ContentOf = std::function<Hash128(const std::filesystem::path& file)>;

/// LuxCore SDL as files on disk. Every reader throws Error(asset) holding all findings, each
/// "file:line: ...": a syntax error, an unknown property of a known thing, a type or property
/// dsbuild does not support yet (said in those words), a missing file, a reference to what is not
/// defined above, a value of the wrong count or range.

/// Reads one material file: `scene.textures.*` and `scene.materials.*`. The material the file is
/// for is the last one defined (others are its parts). No objects, lights or camera may stand in
/// it. Result: a Scene of images, textures and materials only, whose last material is the one
/// wanted. `content_of` is asked for images' hashes; content_hash where there is none.
Scene read_material(const std::filesystem::path& file, const ContentOf& content_of = {});

/// What an environment was read from.
struct EnvironmentSource {
  /// Files that were read, or looked for in vain: where none of them changes, neither does what is read.
  std::vector<std::filesystem::path> files;
  std::string nodes;  ///< node_lines of the scene file (vary_nodes.h)
};

/// Reads an environment folder: `environment.scn` (textures, materials, shapes, objects, lights)
/// and, if there, `environment.cfg` (film.imagepipeline.*: tone map). PLY and image paths are
/// relative to the folder.
/// `source` gets what it was read from.
Scene read_environment(const std::filesystem::path& folder, EnvironmentSource* source = nullptr,
                       const ContentOf& content_of = {});

/// The environment with one more object: `mesh` in `material`'s last material, object id
/// `k_model_object_id`. Indices of the material's scene are moved behind the environment's. The
/// environment's own objects have other ids. Where `material` is a model's own (own_scene), each
/// triangle is in that of its number; throws Error(asset) where these are of another mesh.
Scene compose(const Scene& environment, const Scene& material, Mesh mesh);
inline constexpr std::uint32_t k_model_object_id = 1;

/// What a scene calls a thing that is put into it.
struct ObjectName {
  std::uint32_t id = k_model_object_id;
  std::string name = "model";
};
/// Puts one more thing into a scene, as `compose` does. The model comes last.
void add_object(Scene& scene, const Scene& material, Mesh mesh, ObjectName called);

/// Canonical texts for the render key: everything that can change a pixel, defaults filled in,
/// floats exact, in an order that does not depend on the file's; images by content hash, meshes by
/// geometry_hash, with the uvs and colours that their materials read. Names are those of the SDL ("materials.body.kd = 0x1p-1 0x1p-1 0x1p-1"). The tone
/// map is not in it (it belongs to the files stage).
std::string canonical_material(const Scene& material);
std::string canonical_environment(const Scene& environment);
std::string canonical_tone_map(const ToneMap& tone_map);

}  // namespace ds

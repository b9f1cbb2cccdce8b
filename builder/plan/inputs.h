// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "builder/plan/environment_facts.h"
#include "builder/recipe/camera_fit.h"
#include "builder/recipe/recipe.h"
#include "tracer/base/error.h"
#include "tracer/base/kept.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/own_materials.h"
#include "tracer/scene/scene.h"
#include "tracer/scene/texture_bounds.h"
#include "tracer/scene/vary_nodes.h"

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace ds {

/// Whether a file whose stamp is known is taken for the one that was read before.
enum class Stamps {
  trust,
  ignore,  ///< every file is read: a disk's or a file system's fault leaves the stamp as it was
};

/// A model to be read, and what it must be.
struct ModelSource {
  std::filesystem::path file;
  MeshHashes hashes;  ///< as `Inputs::model_hashes`
  NormaliseOptions options;
  bool shared = false;  ///< images that do not follow each other show it, each in its own way
};

/// Models, read and normalised. The last one is kept: images of one model in several environments
/// follow each other. Safe from several threads.
class ModelMeshes {
 public:
  /// Throws what `read_model` throws, and Error(asset) where the file is no longer the one that was
  /// hashed.
  Mesh get(const ModelSource& source);

 private:
  struct Last {
    std::filesystem::path file;
    Hash128 part;  ///< of the model part
    Mesh mesh;
  };
  /// As its file has it.
  struct KeptMesh {
    FileMesh mesh;
    friend std::size_t bytes_held(const KeptMesh& kept) {
      return kept.mesh.positions.size() *
                 (sizeof(Vec3d) + sizeof(MeshColor) + sizeof(Vec3) + sizeof(Vec2)) +
             kept.mesh.triangles.size() * sizeof(kept.mesh.triangles[0]) + sizeof kept;
    }
  };
  std::shared_ptr<const FileMesh> file_mesh(const ModelSource& source);

  std::mutex mutex_;
  std::optional<Last> last_;
  std::optional<Kept<KeptMesh>> files_;  ///< of those that are shared
};

/// The files a recipe names, each read once. What was hashed before is known by its stamp (size,
/// times, inode), so that looking at thousands of unchanged models reads none of them. A file that
/// cannot be read fails the same way each time it is asked for.
class Inputs {
 public:
  /// The database must outlive this.
  explicit Inputs(Database& database, Stamps stamps = Stamps::trust)
      : database_(database), stamps_(stamps), program_(running_program()) {}
  Stamps stamps() const { return stamps_; }

  /// mesh_hashes of the model as read, before normalisation. Throws what `read_model` throws.
  const MeshHashes& model_hashes(const std::filesystem::path& file) { return model(file).hashes; }
  /// What reading it mended; throws likewise.
  const MendedDamage& model_damage(const std::filesystem::path& file) { return model(file).damage; }
  /// What of its properties is hardly what is meant (unlikely_properties); throws likewise.
  const MendedDamage& model_unlikely(const std::filesystem::path& file) {
    return model(file).unlikely;
  }
  /// The ball around the model as it is normalised; `lowest` as model_to_world takes it. Reads it where
  /// the database does not know it.
  Sphere model_sphere(const std::filesystem::path& file, const NormaliseOptions& options,
                      double lowest = 0);
  /// As its file has it; the last is kept.
  const FileMesh& model_file_mesh(const std::filesystem::path& file);
  /// lowest_of it. Reads it likewise.
  double model_lowest(const std::filesystem::path& file, const NormaliseOptions& options);
  /// What its file has beside places; throws likewise.
  MeshExtras model_has(const std::filesystem::path& file) { return model(file).has; }
  /// Where it lies in its file's coordinates; throws likewise.
  const MeshExtent& model_extent(const std::filesystem::path& file) { return model(file).extent; }
  /// shape_of it; throws likewise.
  const std::string& model_shape(const std::filesystem::path& file) { return model(file).shape; }
  /// As ModelMeshes::get, of the model that `model_hashes` saw.
  Mesh model_mesh(const std::filesystem::path& file, const NormaliseOptions& options) {
    return meshes_.get(model_source(file, options));
  }
  /// For `meshes`, which other threads may ask.
  ModelSource model_source(const std::filesystem::path& file, const NormaliseOptions& options) {
    return {file, model_hashes(file), options, false};
  }
  ModelMeshes& meshes() { return meshes_; }
  /// Those that its file gives its faces; throws what read_own_materials throws. What is not used of them is
  /// in their notes.
  const OwnMaterials& own_materials(const std::filesystem::path& model);
  /// What own_scene makes of these.
  const Scene& own_material(const std::filesystem::path& model);
  /// That of an image: its material's, or its model's own.
  const Scene& material(const ImageSpec& image) {
    return shows_own(image) ? own_material(image.model_file) : material(*image.material_file);
  }
  /// As read_material and read_environment give them; what pixels of their images tell is among
  /// what their materials have of unphysical, and was warned of. They stay, and stay as they are, as
  /// long as this does.
  const Scene& material(const std::filesystem::path& file);
  const Scene& environment(const std::filesystem::path& folder);
  /// Of an environment whose files have the stamps that they had when this program read it, without
  /// reading it, unless there was anything to warn of.
  const EnvironmentFacts& environment_facts(const std::filesystem::path& folder);

  /// What of an environment's lights, materials and textures may be drawn.
  const std::vector<NodeProperty>& environment_properties(const std::filesystem::path& folder);
  /// Those of a name ("emission.gain") of nodes whose names fit a pattern.
  const std::vector<const NodeProperty*>& environment_fits(const std::filesystem::path& folder,
                                                           const std::string& nodes,
                                                           const std::string& property);

  /// What this program found out before, of a question that says all that the answer depends on.
  std::optional<std::string> find_known(const std::string& question);
  void keep_known(const std::string& question, std::string answer);

  /// Writes what was found since the last call into the database.
  void remember();

 private:
  template <typename T>
  struct Read {
    std::optional<T> value;
    std::optional<Error> error;
  };
  /// By path; a path's own comparison takes it apart each time.
  template <typename T>
  using Known = std::unordered_map<std::string, Read<T>>;
  template <typename T, typename Reader>
  const T& once(Known<T>& known, const std::filesystem::path& path, const Reader& reader);
  /// What the database knows of a model, taken apart.
  struct ModelFacts {
    MeshHashes hashes;
    MendedDamage damage, unlikely;
    MeshExtras has;
    MeshExtent extent;
    std::string shape;
  };
  const ModelFacts& model(const std::filesystem::path& file);
  KnownModel look_at_model(const std::filesystem::path& file);
  Hash128 content_of_file(const std::filesystem::path& file);
  using FilesOf = std::vector<std::filesystem::path>(const std::filesystem::path& file);
  /// What `files_of` gives, asked of the file once for each content.
  std::vector<std::filesystem::path> files_named(const char* kind,
                                                 const std::filesystem::path& file,
                                                 const Hash128& content, FilesOf* files_of);
  /// Of a model file and of the files that hold its parts.
  Hash128 content_with_parts(const std::filesystem::path& file, const Hash128& content);
  std::optional<InputBounds> image_bounds(const Image& image);
  void look_at_pixels(Scene& scene);

  struct NewModel {
    std::filesystem::path file;
    std::optional<FileStamp> stamp;
    Hash128 content, whole;  ///< of the file, and with its parts
    KnownModel known;
  };

  Database& database_;
  Stamps stamps_;
  Known<ModelFacts> models_;
  Known<Scene> materials_, own_scenes_, environments_;
  Known<OwnMaterials> own_materials_;
  Known<EnvironmentFacts> environment_facts_;
  std::unordered_map<std::string, std::string> environment_nodes_;  ///< of environments_
  Known<std::vector<NodeProperty>> environment_properties_;
  std::unordered_map<std::string, std::vector<const NodeProperty*>> environment_fits_;
  std::string program_;  ///< running_program
  std::map<std::string, std::string> new_known_;
  Known<Hash128> contents_;  ///< of images and models' parts
  struct NewContent {
    std::filesystem::path file;
    FileStamp stamp;
    Hash128 content;
  };
  std::vector<NewContent> new_contents_;
  std::vector<NewModel> new_models_;
  ModelMeshes meshes_;
  std::unordered_map<std::string, Sphere> spheres_;  ///< by canonical_model
  /// The last that was asked for its lowest point.
  struct LastFile {
    std::filesystem::path file;
    FileMesh mesh;
  };
  std::optional<LastFile> last_file_;
  std::map<Hash128, Sphere> new_spheres_;      ///< by the hash of the model part
  std::map<Hash128, InputBounds> new_bounds_;  ///< by the hash of the image and its use
};

}  // namespace ds

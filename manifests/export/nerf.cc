// SPDX-License-Identifier: Apache-2.0
// NeRF as nerfstudio reads it: a folder for each static scene, which is a model in one material and
// environment, with transforms.json, images and masks. What else differs between its views is said. Splits of a dataset are of its models; which views
// train a scene is left to the reader.
#include "manifests/export/exporter.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace ds {
namespace {

/// Camera to world of an OpenGL camera (x right, y up, z backward) as nested rows.
nlohmann::json opengl_pose(const std::array<double, 16>& pose) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t row = 0; row < 4; ++row) {
    const double* p = &pose[4 * row];
    // Subtracted from 0, so that no 0 becomes -0.
    rows.push_back({p[0], 0.0 - p[1], 0.0 - p[2], p[3]});
  }
  return rows;
}

bool same_things(const ImageRecord& a, const ImageRecord& b) {
  return std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(),
                    [](const ObjectRecord& one, const ObjectRecord& other) {
                      return one.model == other.model && one.material == other.material &&
                             one.pose == other.pose;
                    });
}

/// What a drawn key changes of a scene or its pictures; null: the camera alone, or what is told by more than
/// the key.
const char* change_of(std::string_view key) {
  if (key == "outputs.camera.exposure_ev") return "exposure";
  if (key.starts_with("outputs.camera.")) return "picture effects";
  if (key.starts_with("environments.")) return "environment (turn, gain, temperature)";
  if (key.starts_with("lights")) return "lights";
  if (key.starts_with("materials.")) return "material";
  return nullptr;
}

/// What of one scene differs between two of its pictures.
void add_changes(std::set<std::string>& to, const ImageRecord& a, const ImageRecord& b) {
  if (a.pose != b.pose) to.insert("model pose");
  if (!same_things(a, b)) to.insert("objects");
  if (a.tone_map_scale != b.tone_map_scale) to.insert("exposure");
  for (const auto& [one, other] : {std::pair(&a.draws, &b.draws), std::pair(&b.draws, &a.draws)})
    for (const auto& [key, draw] : *one) {
      const auto at = other->find(key);
      const char* change = change_of(key);
      if (change != nullptr && (at == other->end() || at->second != draw)) to.insert(change);
    }
}

class Nerf : public Exporter {
 public:
  Nerf(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {}

  void add(const ExportImage& image) override {
    const ImageRecord& record = image.record;
    // Ordered by id, all images of a model follow each other.
    if (record.model != model_) write_scenes();
    model_ = record.model;
    if (record.lens_radius_m > 0)
      to_.note(
          "pictures have depth of field, which a pinhole camera model cannot explain "
          "(camera.lens_radius_m = 0 leaves it out)");
    const std::array<double, 9>& k = intrinsics_for("nerf", record);
    const std::string stem = image.key.substr(0, image.key.rfind("-" + record.view));
    Scene& scene = scenes_[fmt::format("{}-{}-{}", stem, record.material, record.environment)];
    if (scene.frames.empty()) scene.first = record;
    add_changes(scene.changes, scene.first, record);
    scene.lenses.push_back({{"fl_x", k[0]},
                            {"fl_y", k[4]},
                            {"cx", k[2]},
                            {"cy", k[5]},
                            {"w", record.width},
                            {"h", record.height}});
    nlohmann::json frame{{"transform_matrix", opengl_pose(record.camera_to_world)}};
    frame["file_path"] = add_file(scene, image, "image", "images");
    if (input_.has("mask")) frame["mask_path"] = add_file(scene, image, "mask", "masks");
    scene.frames.push_back(std::move(frame));
  }

  void finish() override {
    write_scenes();
    if (moving_ > 0)
      to_.note(
          fmt::format("{} of {} scenes are not one still scene, since their frames differ in {}",
                      moving_, all_, fmt::join(changes_, ", ")));
  }

 private:
  struct Scene {
    ImageRecord first;
    std::set<std::string> changes;
    std::vector<nlohmann::json> lenses;  ///< intrinsics and size of each frame
    nlohmann::json frames = nlohmann::json::array();
    std::vector<std::pair<FileRecord, std::string>> files;
  };

  static std::string add_file(Scene& scene, const ExportImage& image, const char* kind,
                              const char* folder) {
    const FileRecord& file = file_of(image, kind);
    std::string path = fmt::format("{}/{}{}", folder, image.key, ending_of(file));
    scene.files.emplace_back(file, path);
    return path;
  }

  /// Intrinsics stand with the frames where they differ: readers look there for what the head lacks.
  static std::string text_of(Scene& scene) {
    nlohmann::json text{
        {"camera_model", "OPENCV"}, {"k1", 0.0}, {"k2", 0.0}, {"p1", 0.0}, {"p2", 0.0}};
    const std::vector<nlohmann::json>& lenses = scene.lenses;
    if (std::adjacent_find(lenses.begin(), lenses.end(), std::not_equal_to{}) == lenses.end())
      text.update(lenses.front());
    else
      for (std::size_t i = 0; i < lenses.size(); ++i)
        scene.frames[i].update(lenses[i]);
    text["frames"] = std::move(scene.frames);
    return canonical_json(text, 1);
  }

  void write_scenes() {
    for (auto& [name, scene] : scenes_) {
      if (scene.frames.size() < 2)
        to_.note(
            "scenes of a single view teach no depth: materials.per and environments.per = "
            "\"model\" keep a model's views together");
      ++all_;
      if (!scene.changes.empty()) ++moving_;
      changes_.merge(scene.changes);
      for (const auto& [file, path] : scene.files)
        to_.place(file, fmt::format("{}/{}", name, path));
      to_.write(name + "/transforms.json", text_of(scene));
    }
    scenes_.clear();
  }

  const ExportInput& input_;
  ExportFolder& to_;
  std::string model_;
  std::map<std::string, Scene> scenes_;  ///< of the model
  std::uint64_t all_ = 0, moving_ = 0;   ///< scenes
  std::set<std::string> changes_;        ///< of all
};

}  // namespace

ExporterType nerf_exporter() {
  return {"nerf",
          "NeRF (nerfstudio): a folder with transforms.json for each model, material, environment",
          {"image"},
          {"image", "mask"},
          false,
          make_exporter<Nerf>,
          false,
          "World: right-handed, z up, metres. Cameras of transform_matrix: x right, y up, z "
          "backward (OpenGL); pixel centres at .5."};
}

}  // namespace ds

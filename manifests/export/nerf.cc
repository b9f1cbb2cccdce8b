// SPDX-License-Identifier: Apache-2.0
// NeRF as nerfstudio reads it: a folder for each static scene, which is a model in one material and
// environment, with transforms.json, images and masks. Splits of a dataset are of its models; which views
// train a scene is left to the reader.
#include "manifests/export/exporter.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

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
    if (scene.frames.empty()) {
      scene.head = {{"camera_model", "OPENCV"},
                    {"fl_x", k[0]},
                    {"fl_y", k[4]},
                    {"cx", k[2]},
                    {"cy", k[5]},
                    {"w", record.width},
                    {"h", record.height},
                    {"k1", 0.0},
                    {"k2", 0.0},
                    {"p1", 0.0},
                    {"p2", 0.0}};
    }
    nlohmann::json frame{{"transform_matrix", opengl_pose(record.camera_to_world)}};
    frame["file_path"] = add_file(scene, image, "image", "images");
    if (input_.has("mask")) frame["mask_path"] = add_file(scene, image, "mask", "masks");
    scene.frames.push_back(std::move(frame));
  }

  void finish() override { write_scenes(); }

 private:
  struct Scene {
    nlohmann::json head;
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

  void write_scenes() {
    for (auto& [name, scene] : scenes_) {
      if (scene.frames.size() < 2)
        to_.note(
            "scenes of a single view teach no depth: materials.per and environments.per = "
            "\"model\" keep a model's views together");
      for (const auto& [file, path] : scene.files)
        to_.place(file, fmt::format("{}/{}", name, path));
      scene.head["frames"] = std::move(scene.frames);
      to_.write(name + "/transforms.json", canonical_json(scene.head, 1));
    }
    scenes_.clear();
  }

  const ExportInput& input_;
  ExportFolder& to_;
  std::string model_;
  std::map<std::string, Scene> scenes_;  ///< of the model
};

}  // namespace

ExporterType nerf_exporter() {
  return {"nerf",
          "NeRF (nerfstudio): a folder with transforms.json for each model, material, environment",
          {"image"},
          {"image", "mask"},
          false,
          make_exporter<Nerf>};
}

}  // namespace ds

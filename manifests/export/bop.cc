// SPDX-License-Identifier: Apache-2.0
// BOP, for the pose of objects: models/obj_NNNNNN.ply in millimetres, and of each split scenes of up to
// 1,000 images with cameras, poses, boxes and masks. A size that a recipe gave the model is in the PLY
// file, so that poses are rotations. BOP's pixel centres are at whole numbers.
#include "manifests/export/bop_model.h"
#include "manifests/export/exporter.h"
#include "manifests/export/run_lengths.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"
#include "tracer/render/develop.h"
#include "tracer/render/image_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

constexpr std::size_t k_scene_images = 1000;
/// A tick of a depth file made here, in millimetres: 16 bits reach 6.5 m.
constexpr double k_depth_tick_mm = 0.1;

struct DepthPixels {
  std::vector<std::uint16_t> ticks;
  double tick_mm = 1;
  bool made = false;  ///< of an EXR file; else the file is as BOP wants it
};

DepthPixels read_depth(const ExportInput& input, const ExportImage& image, ExportFolder& to) {
  const FileRecord& file = file_of(image, "depth");
  const std::string name = (input.folder / file.path).string();
  const std::string bytes = read_checked(input.folder, file);
  const DecodedImage decoded = decode_image_bytes(bytes_of(bytes), name, Halves::widen);
  DepthPixels depth;
  if (decoded.type == SampleType::uint16) {
    depth.ticks.resize(decoded.samples.size() / 2);
    std::memcpy(depth.ticks.data(), decoded.samples.data(), decoded.samples.size());
    return depth;
  }
  if (decoded.type != SampleType::float32 || decoded.channels != 1)
    fail(ErrorKind::asset, "{}: wanted a depth of one channel, found {} of {}", name,
         decoded.channels, sample_type_name(decoded.type));
  std::vector<float> metres(decoded.samples.size() / sizeof(float));
  std::memcpy(metres.data(), decoded.samples.data(), decoded.samples.size());
  depth.tick_mm = k_depth_tick_mm;
  depth.made = true;
  for (const float m : metres) {
    const double ticks = std::round(double{m} * 1000 / k_depth_tick_mm);
    if (ticks > 65535) to.note("depths beyond 6.5 m are 0 (depth: \"png16\" reaches 65.5 m)");
    depth.ticks.push_back(ticks > 65535 ? std::uint16_t{0} : static_cast<std::uint16_t>(ticks));
  }
  return depth;
}

std::vector<double> rotation_of(const std::array<double, 12>& m) {
  return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
}
std::vector<double> translation_of(const std::array<double, 12>& m) {
  return {m[3], m[7], m[11]};
}

/// World in metres to the camera in millimetres.
std::array<double, 12> world_to_camera(const std::array<double, 16>& pose) {
  std::array<double, 12> m{};
  for (std::size_t row = 0; row < 3; ++row) {
    double move = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      m[4 * row + k] = pose[4 * k + row] + 0.0;  // no -0
      move -= pose[4 * k + row] * pose[4 * k + 3];
    }
    m[4 * row + 3] = 1000 * move + 0.0;
  }
  return m;
}

std::array<double, 12> model_to_camera(const std::array<double, 12>& world, Vec3d middle_m) {
  std::array<double, 12> m = world;
  for (std::size_t row = 0; row < 3; ++row)
    m[4 * row + 3] += 1000 * (world[4 * row] * middle_m.x + world[4 * row + 1] * middle_m.y +
                              world[4 * row + 2] * middle_m.z);
  return m;
}

/// The model of the first image's pose to that of an image's own: the world, moved with it.
std::array<double, 12> moved_with(const std::array<double, 12>& world, const ModelPose& first,
                                  const ModelPose& own, const ImageRecord& record) {
  if (own == first) return world;
  // Both are a rotation times a size, so that an inverse is a transpose over the size's square.
  const auto &a = first.model_to_world, &b = own.model_to_world;
  const auto squared_size = [](const std::array<double, 16>& m) {
    return m[0] * m[0] + m[4] * m[4] + m[8] * m[8];
  };
  const double size = squared_size(a);
  constexpr double k_rounding = 1e-9;
  if (std::abs(squared_size(b) - size) > k_rounding * size)
    fail(ErrorKind::asset,
         "the image {}: shows its model in another size than other images, and bop has one for "
         "all: models.size_m with per = \"model\" gives each model one",
         record.id);
  std::array<double, 12> move{};  // own x inverse of first
  for (std::size_t row = 0; row < 3; ++row) {
    move[4 * row + 3] = b[4 * row + 3];
    for (std::size_t column = 0; column < 3; ++column) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += b[4 * row + k] * a[4 * column + k];
      move[4 * row + column] = sum / size;
      move[4 * row + 3] -= move[4 * row + column] * a[4 * column + 3];
    }
  }
  std::array<double, 12> m{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t k = 0; k < 3; ++k)
        m[4 * row + column] += world[4 * row + k] * move[4 * k + column];
    m[4 * row + 3] = world[4 * row + 3];
    for (std::size_t k = 0; k < 3; ++k)
      m[4 * row + 3] += 1000 * world[4 * row + k] * move[4 * k + 3];
  }
  return m;
}

/// As the format's toolkit counts: greatest less least.
std::vector<int> box_of(const MaskPixels& mask) {
  const auto box = tight_box(mask);
  if (!box) return {-1, -1, -1, -1};
  return {(*box)[0], (*box)[1], (*box)[2] - 1, (*box)[3] - 1};
}

/// A file of one object whose members are added one after the other.
class Members {
 public:
  void add(const std::string& name, const json& value) {
    text_ +=
        fmt::format("{}\"{}\": {}", text_.empty() ? "{\n" : ",\n", name, canonical_json(value));
  }
  std::string text() const { return (text_.empty() ? "{" : text_) + "\n}\n"; }

 private:
  std::string text_;
};

struct Scene {
  std::string folder;
  std::size_t number = 0, images = 0;
  Members camera, gt, info;
  std::string coco_images, coco_annotations;
};

class Bop : public Exporter {
 public:
  Bop(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {
    if (!input.mesh)
      fail(ErrorKind::usage,
           "the format bop holds the models themselves: name the recipe, whose models are read, in "
           "place of the folder");
  }

  void add(const ExportImage& image) override {
    const ImageRecord& record = image.record;
    if (record.model != model_name_) take_model(image);
    Scene& scene = scene_of(image.split);
    const std::string number = fmt::format("{:06}", scene.images);
    to_.place(file_of(image, "image"), scene.folder + "/rgb/" + number + ".png");
    const DepthPixels depth = read_depth(input_, image, to_);
    place_depth(image, depth, scene.folder + "/depth/" + number + ".png");
    to_.place(file_of(image, "amodal_mask"), scene.folder + "/mask/" + number + "_000000.png");
    to_.place(file_of(image, "mask"), scene.folder + "/mask_visib/" + number + "_000000.png");
    add_labels(scene, image, depth);
    ++scene.images;
  }

  void finish() override;

 private:
  void take_model(const ExportImage& image);
  Scene& scene_of(const std::string& split);
  void write_scene(const Scene& scene);
  void place_depth(const ExportImage& image, const DepthPixels& depth, const std::string& path);
  void add_labels(Scene& scene, const ExportImage& image, const DepthPixels& depth);
  void add_coco(Scene& scene, const ImageRecord& record, const MaskPixels& mask);

  const ExportInput& input_;
  ExportFolder& to_;
  std::string model_name_;  ///< images of one model follow each other
  BopModel model_;
  ModelPose pose_;            ///< in which model_ was taken
  std::uint64_t object_ = 0;  ///< from 1
  Members models_info_;
  json objects_ = json::object();
  std::map<std::string, Scene> scenes_;  ///< the last of each split
  json targets_ = json::array();
  json camera_;
};

void Bop::take_model(const ExportImage& image) {
  const ImageRecord& record = image.record;
  if (!record.pose)
    fail(ErrorKind::asset, "the image {}: its line has no model_to_world; dsbuild build writes it",
         record.id);
  model_name_ = record.model;
  pose_ = *record.pose;
  model_ = bop_model(input_.mesh(record), pose_);
  ++object_;
  to_.write(fmt::format("models/obj_{:06}.ply", object_), ply_text(model_));
  const Vec3d side = model_.most - model_.least;
  models_info_.add(std::to_string(object_), {{"diameter", model_.diameter},
                                             {"min_x", model_.least.x},
                                             {"min_y", model_.least.y},
                                             {"min_z", model_.least.z},
                                             {"size_x", side.x},
                                             {"size_y", side.y},
                                             {"size_z", side.z}});
  objects_[std::to_string(object_)] = {{"model", record.model}, {"class_path", record.class_path}};
}

Scene& Bop::scene_of(const std::string& split) {
  Scene& scene = scenes_[split];
  if (scene.images == k_scene_images) {
    write_scene(scene);
    scene = Scene{"", scene.number + 1, 0, {}, {}, {}, "", ""};
  }
  if (scene.folder.empty()) scene.folder = fmt::format("{}/{:06}", split, scene.number);
  return scene;
}

void Bop::place_depth(const ExportImage& image, const DepthPixels& depth, const std::string& path) {
  if (!depth.made) return to_.place(file_of(image, "depth"), path);
  const std::vector<std::byte> png =
      encode_png(DeepPicture{image.record.width, image.record.height, 1, depth.ticks});
  to_.write(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

void Bop::add_labels(Scene& scene, const ExportImage& image, const DepthPixels& depth) {
  const ImageRecord& record = image.record;
  const std::string number = std::to_string(scene.images);
  const auto world = world_to_camera(record.camera_to_world);
  if (!record.pose)
    fail(ErrorKind::asset, "the image {}: its line has no model_to_world; dsbuild build writes it",
         record.id);
  const auto to_camera =
      model_to_camera(moved_with(world, pose_, *record.pose, record), model_.middle_m);
  const std::array<double, 9>& pinhole = intrinsics_for("bop", record);
  std::array<double, 9> k = pinhole;
  k[2] -= 0.5;
  k[5] -= 0.5;
  scene.camera.add(number, {{"cam_K", k},
                            {"depth_scale", depth.tick_mm},
                            {"cam_R_w2c", rotation_of(world)},
                            {"cam_t_w2c", translation_of(world)}});
  if (camera_.is_null())
    camera_ = {{"cx", k[2]},
               {"cy", k[5]},
               {"fx", k[0]},
               {"fy", k[4]},
               {"width", record.width},
               {"height", record.height},
               {"depth_scale", depth.tick_mm}};
  scene.gt.add(number, json::array({{{"obj_id", object_},
                                     {"cam_R_m2c", rotation_of(to_camera)},
                                     {"cam_t_m2c", translation_of(to_camera)}}}));
  const MaskPixels mask = read_mask(input_, image), whole = read_mask(input_, image, "amodal_mask");
  const Silhouette all = silhouette(model_, to_camera, pinhole, record.width, record.height);
  if (!all.whole)
    to_.note("models of which some is behind the camera: px_count_all and bbox_obj lack that");
  // By the picture's own rays where it holds all of the model.
  const bool inside = all.box[0] > 0 && all.box[1] > 0 &&
                      all.box[0] + all.box[2] < record.width - 1 &&
                      all.box[1] + all.box[3] < record.height - 1;
  const std::uint64_t pixels = inside ? area_of(whole) : std::max(all.pixels, area_of(whole));
  std::uint64_t valid = 0;
  for (std::size_t i = 0; i < whole.values.size(); ++i)
    valid += whole.values[i] != 0 && depth.ticks[i] != 0 ? 1U : 0U;
  const std::uint64_t seen = area_of(mask);
  const double fraction =
      pixels == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(pixels);
  scene.info.add(number, json::array({{{"bbox_obj", inside ? json(box_of(whole)) : json(all.box)},
                                       {"bbox_visib", box_of(mask)},
                                       {"px_count_all", pixels},
                                       {"px_count_valid", valid},
                                       {"px_count_visib", seen},
                                       {"visib_fract", fraction}}}));
  if (image.split == "test" && fraction >= 0.1)
    targets_.push_back({{"scene_id", scene.number},
                        {"im_id", scene.images},
                        {"obj_id", object_},
                        {"inst_count", 1}});
  add_coco(scene, record, mask);
}

void Bop::add_coco(Scene& scene, const ImageRecord& record, const MaskPixels& mask) {
  const auto append = [](std::string& list, const json& object) {
    list += (list.empty() ? "" : ",\n") + canonical_json(object);
  };
  append(scene.coco_images, {{"id", scene.images},
                             {"file_name", fmt::format("rgb/{:06}.png", scene.images)},
                             {"width", record.width},
                             {"height", record.height},
                             {"dsbuild_id", record.id}});
  const auto box = tight_box(mask);
  if (!box) return;
  append(scene.coco_annotations,
         {{"id", scene.images + 1},
          {"image_id", scene.images},
          {"category_id", object_},
          {"iscrowd", 0},
          {"ignore", false},
          {"area", area_of(mask)},
          {"bbox", *box},
          {"width", record.width},
          {"height", record.height},
          {"segmentation",
           {{"size", {mask.height, mask.width}}, {"counts", run_length_text(run_lengths(mask))}}}});
}

void Bop::write_scene(const Scene& scene) {
  to_.write(scene.folder + "/scene_camera.json", scene.camera.text());
  to_.write(scene.folder + "/scene_gt.json", scene.gt.text());
  to_.write(scene.folder + "/scene_gt_info.json", scene.info.text());
  std::string categories;
  for (const auto& [id, object] : objects_.items())
    categories += fmt::format("{}{}", categories.empty() ? "" : ",\n",
                              canonical_json({{"id", std::stoull(id)},
                                              {"name", object["model"]},
                                              {"supercategory", input_.dataset.name}}));
  to_.write(scene.folder + "/scene_gt_coco.json",
            fmt::format("{{\"categories\":[{}],\n\"images\":[{}],\n\"annotations\":[{}]}}\n",
                        categories, scene.coco_images, scene.coco_annotations));
}

void Bop::finish() {
  for (const auto& [split, scene] : scenes_)
    write_scene(scene);
  to_.write("models/models_info.json", models_info_.text());
  to_.write("camera.json", canonical_json(camera_, 1));
  to_.write("dataset_info.json", canonical_json({{"name", input_.dataset.name},
                                                 {"licence", input_.dataset.licence},
                                                 {"objects", objects_}},
                                                1));
  if (!targets_.empty()) to_.write("test_targets_bop19.json", canonical_json(targets_, 1));
}

}  // namespace

ExporterType bop_exporter() {
  return {"bop",
          "BOP, for poses: models in millimetres, SPLIT/SCENE with cameras, poses, boxes and masks",
          {"image", "mask", "amodal_mask", "depth"},
          {"image", "mask", "amodal_mask", "depth"},
          false,
          make_exporter<Bop>};
}

}  // namespace ds

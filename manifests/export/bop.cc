// SPDX-License-Identifier: Apache-2.0
// BOP, for the pose of objects: models/obj_NNNNNN.ply in millimetres, and of each split scenes of up to
// 1,000 images with cameras, poses, boxes and masks. A size that a recipe gave the model is in the PLY
// file, so that poses are rotations. BOP's pixel centres are at whole numbers.
#include "manifests/export/bop_model.h"
#include "manifests/export/exporter.h"
#include "manifests/export/run_lengths.h"
#include "manifests/export/shown_objects.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"
#include "tracer/render/develop.h"
#include "tracer/render/image_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <set>
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

void add_line(std::string& list, const json& object) {
  list += (list.empty() ? "" : ",\n") + canonical_json(object);
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
  std::size_t number = 0, images = 0, annotations = 0;
  Members camera, gt, info;
  std::string coco_images, coco_annotations;
};

/// A model in one size, which is an object of the format's.
struct BopObject {
  std::uint64_t id = 0;             ///< from 1
  ModelPose pose;                   ///< in which the model was taken
  std::shared_ptr<BopModel> model;  ///< none: to be read again
};

/// Of an object in an image.
struct ObjectPixels {
  MaskPixels visible, whole;
};

double size_of(const ModelPose& pose) {
  const auto& m = pose.model_to_world;
  return std::sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]);
}

/// What tells the models of a dataset apart, each in its size.
std::string object_key(const std::string& name, const ModelPose& pose) {
  const Vec3d low = pose.model_box.least, high = pose.model_box.most;
  return fmt::format("{}\n{:.12g} {} {} {} {} {} {}", name, size_of(pose), low.x, low.y, low.z,
                     high.x, high.y, high.z);
}

class Bop : public Exporter {
 public:
  Bop(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {
    if (!input.mesh)
      fail(ErrorKind::usage,
           "the format bop holds the models themselves: name the recipe, whose models are read, in "
           "place of the folder");
  }

  void add(const ExportImage& image) override;
  void finish() override;

 private:
  const BopObject& object_of(const std::string& name, const std::string& class_path,
                             const ModelPose& pose, const std::function<FileMesh()>& mesh);
  const BopObject& model_of(const ImageRecord& record);
  const BopObject& other_of(const ObjectRecord& record);
  Scene& scene_of(const std::string& split);
  void write_scene(const Scene& scene);
  void place_depth(const ExportImage& image, const DepthPixels& depth, const std::string& path);
  void add_camera(Scene& scene, const ImageRecord& record, const DepthPixels& depth);
  void place_masks(const ExportImage& image, const Scene& scene, std::size_t place,
                   const ObjectPixels& pixels);
  json info_of(const ObjectPixels& pixels, const Silhouette& all, const DepthPixels& depth);
  void add_coco(Scene& scene, const ImageRecord& record, std::uint64_t object,
                const MaskPixels& mask);

  const ExportInput& input_;
  ExportFolder& to_;
  std::map<std::string, BopObject> known_;  ///< by object_key
  std::size_t points_ = 0;                  ///< that their models hold
  std::set<std::string> names_;             ///< of them
  std::string model_name_;                  ///< images of one model follow each other
  ModelPose model_pose_;                    ///< of its first
  Members models_info_;
  json objects_ = json::object();
  std::map<std::string, Scene> scenes_;  ///< the last of each split
  json targets_ = json::array();
  json camera_;
};

const BopObject& Bop::object_of(const std::string& name, const std::string& class_path,
                                const ModelPose& pose, const std::function<FileMesh()>& mesh) {
  constexpr std::size_t k_most_points = 4'000'000;
  BopObject& object = known_[object_key(name, pose)];
  if (object.model) return object;
  if (points_ > k_most_points) {
    for (auto& [key, other] : known_)
      other.model.reset();
    points_ = 0;
  }
  const bool is_new = object.id == 0;
  if (is_new) object = {known_.size(), pose, nullptr};
  object.model = std::make_shared<BopModel>(bop_model(mesh(), object.pose));
  points_ += object.model->points.size();
  if (!is_new) return object;
  names_.insert(name);
  const BopModel& model = *object.model;
  to_.write(fmt::format("models/obj_{:06}.ply", object.id), ply_text(model));
  const Vec3d side = model.most - model.least;
  models_info_.add(std::to_string(object.id), {{"diameter", model.diameter},
                                               {"min_x", model.least.x},
                                               {"min_y", model.least.y},
                                               {"min_z", model.least.z},
                                               {"size_x", side.x},
                                               {"size_y", side.y},
                                               {"size_z", side.z}});
  objects_[std::to_string(object.id)] = {
      {"model", name}, {"class_path", class_path}, {"mm_per_unit", 1000 * size_of(object.pose)}};
  return object;
}

/// In the size of the model's first image.
const BopObject& Bop::model_of(const ImageRecord& record) {
  if (!record.pose)
    fail(ErrorKind::asset, "the image {}: its line has no model_to_world; dsbuild build writes it",
         record.id);
  if (record.model != model_name_) {
    model_name_ = record.model;
    model_pose_ = *record.pose;
  }
  return object_of(record.model, record.class_path, model_pose_,
                   [&] { return input_.mesh(record); });
}

const BopObject& Bop::other_of(const ObjectRecord& record) {
  return object_of(record.model, record.class_path, record.pose,
                   [&] { return input_.object_mesh(record); });
}

Scene& Bop::scene_of(const std::string& split) {
  Scene& scene = scenes_[split];
  if (scene.images == k_scene_images) {
    write_scene(scene);
    scene = Scene{"", scene.number + 1, 0, 0, {}, {}, {}, "", ""};
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

/// The model's masks are the dataset's files.
void Bop::place_masks(const ExportImage& image, const Scene& scene, std::size_t place,
                      const ObjectPixels& pixels) {
  const std::string name = fmt::format("{:06}_{:06}.png", scene.images, place);
  if (place == 0) {
    to_.place(file_of(image, "amodal_mask"), scene.folder + "/mask/" + name);
    to_.place(file_of(image, "mask"), scene.folder + "/mask_visib/" + name);
    return;
  }
  for (const auto& [folder, mask] :
       {std::pair("/mask/", &pixels.whole), std::pair("/mask_visib/", &pixels.visible)}) {
    const std::vector<std::byte> png =
        encode_png(BytePicture{mask->width, mask->height, 1, mask->values});
    to_.write(scene.folder + folder + name,
              {reinterpret_cast<const char*>(png.data()), png.size()});
  }
}

void Bop::add_camera(Scene& scene, const ImageRecord& record, const DepthPixels& depth) {
  const auto world = world_to_camera(record.camera_to_world);
  std::array<double, 9> k = intrinsics_for("bop", record);
  k[2] -= 0.5;
  k[5] -= 0.5;
  scene.camera.add(std::to_string(scene.images), {{"cam_K", k},
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
}

json Bop::info_of(const ObjectPixels& pixels, const Silhouette& all, const DepthPixels& depth) {
  const MaskPixels& whole = pixels.whole;
  if (!all.whole)
    to_.note("models of which some is behind the camera: px_count_all and bbox_obj lack that");
  // By the picture's own rays where it holds all of the model.
  const bool inside = all.box[0] > 0 && all.box[1] > 0 &&
                      all.box[0] + all.box[2] < whole.width - 1 &&
                      all.box[1] + all.box[3] < whole.height - 1;
  const std::uint64_t count = inside ? area_of(whole) : std::max(all.pixels, area_of(whole));
  std::uint64_t valid = 0;
  for (std::size_t i = 0; i < whole.values.size(); ++i)
    valid += whole.values[i] != 0 && depth.ticks[i] != 0 ? 1U : 0U;
  const std::uint64_t seen = area_of(pixels.visible);
  return {
      {"bbox_obj", inside ? json(box_of(whole)) : json(all.box)},
      {"bbox_visib", box_of(pixels.visible)},
      {"px_count_all", count},
      {"px_count_valid", valid},
      {"px_count_visib", seen},
      {"visib_fract", count == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(count)}};
}

/// Of what an image shows beside its model, no plane holds the whole: its mesh tells it.
MaskPixels whole_mask(const Silhouette& all, MaskPixels visible) {
  for (const auto& [x, y] : all.inside)
    visible.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(visible.width) +
                   static_cast<std::size_t>(x)] = 255;
  return visible;
}

void Bop::add(const ExportImage& image) {
  const ImageRecord& record = image.record;
  Scene& scene = scene_of(image.split);
  const std::string number = fmt::format("{:06}", scene.images);
  to_.place(file_of(image, "image"), scene.folder + "/rgb/" + number + ".png");
  const DepthPixels depth = read_depth(input_, image, to_);
  place_depth(image, depth, scene.folder + "/depth/" + number + ".png");
  add_camera(scene, record, depth);
  const auto world = world_to_camera(record.camera_to_world);
  json gt = json::array(), info = json::array();
  std::map<std::uint64_t, std::uint64_t> targets;  // instances by object
  for (ListedObject& shown : shown_objects(input_, image)) {
    const bool is_model = shown.record == nullptr;
    const BopObject& object = is_model ? model_of(record) : other_of(*shown.record);
    const ModelPose& pose = is_model ? *record.pose : shown.record->pose;
    const auto to_camera =
        model_to_camera(moved_with(world, object.pose, pose, record), object.model->middle_m);
    const Silhouette all = silhouette(*object.model, to_camera, intrinsics_for("bop", record),
                                      record.width, record.height);
    ObjectPixels pixels{std::move(shown.mask), {}};
    pixels.whole =
        is_model ? read_mask(input_, image, "amodal_mask") : whole_mask(all, pixels.visible);
    place_masks(image, scene, gt.size(), pixels);
    gt.push_back({{"obj_id", object.id},
                  {"cam_R_m2c", rotation_of(to_camera)},
                  {"cam_t_m2c", translation_of(to_camera)}});
    info.push_back(info_of(pixels, all, depth));
    if (info.back()["visib_fract"] >= 0.1) ++targets[object.id];
    add_coco(scene, record, object.id, pixels.visible);
  }
  scene.gt.add(std::to_string(scene.images), gt);
  scene.info.add(std::to_string(scene.images), info);
  if (image.split == "test")
    for (const auto& [object, count] : targets)
      targets_.push_back({{"scene_id", scene.number},
                          {"im_id", scene.images},
                          {"obj_id", object},
                          {"inst_count", count}});
  add_line(scene.coco_images, {{"id", scene.images},
                               {"file_name", fmt::format("rgb/{:06}.png", scene.images)},
                               {"width", record.width},
                               {"height", record.height},
                               {"dsbuild_id", record.id}});
  ++scene.images;
}

void Bop::add_coco(Scene& scene, const ImageRecord& record, std::uint64_t object,
                   const MaskPixels& mask) {
  const auto box = tight_box(mask);
  ++scene.annotations;
  if (!box) return;
  add_line(
      scene.coco_annotations,
      {{"id", scene.annotations},
       {"image_id", scene.images},
       {"category_id", object},
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
  if (known_.size() > names_.size())
    to_.note(
        fmt::format("models that are shown in several sizes are several objects: {} objects of {} "
                    "models (mm_per_unit in dataset_info.json tells each one's size)",
                    known_.size(), names_.size()));
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
  return {
      "bop",
      "BOP, for poses: models in millimetres, SPLIT/SCENE with cameras, poses, boxes and masks",
      {"image", "mask", "amodal_mask", "depth"},
      {"image", "mask", "amodal_mask", "depth"},
      false,
      make_exporter<Bop>,
      true,
      "Poses take an object of models, in millimetres with the origin in the middle of its box, "
      "to a camera: x right, y down, z forward; pixel centres at whole numbers. bbox_obj and "
      "bbox_visib of scene_gt_info.json are [x, y, greatest x less least, greatest y less "
      "least], as BOP's toolkit has them: one less than a width and height in pixels. A bbox of "
      "scene_gt_coco.json is [x, y, width, height] in whole pixels."};
}

}  // namespace ds

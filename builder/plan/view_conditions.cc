// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/view_conditions.h"

#include "builder/plan/distractors.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/keys.h"
#include "manifests/camera_geometry.h"
#include "manifests/truncation.h"
#include "tracer/base/canonical.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/sdl_math.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace ds {
namespace {

constexpr int k_rays = 64;                // along each side of the picture
constexpr std::size_t k_most_trees = 64;  // of distractors' models
constexpr int k_most_pixels = 128;        // of the longer side, to tell what is in the frame

std::vector<std::array<Vec3, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<Vec3, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return triangles;
}

struct Ray {
  Vec3d origin, direction;
};

/// The pinhole's ray, or one of parallel ones, through the middle of field (x, y).
Ray ray_through(const Camera& camera, const std::array<double, 16>& pose, int width, int height,
                int x, int y) {
  const Vec3d right{pose[0], pose[4], pose[8]}, down{pose[1], pose[5], pose[9]},
      forward{pose[2], pose[6], pose[10]};
  const double longer = std::max(width, height);
  const double across = (2 * (x + 0.5) / k_rays - 1) * width / longer;
  const double below = (2 * (y + 0.5) / k_rays - 1) * height / longer;
  if (type_of(camera).host.span == kernels::CameraSpan::fov_deg) {
    const double tangent = sin_deg(camera.fov_deg / 2) / cos_deg(camera.fov_deg / 2);
    return {camera.position, forward + right * (across * tangent) + down * (below * tangent)};
  }
  const double half_m = camera.extent_m / 2;
  return {camera.position + right * (across * half_m) + down * (below * half_m), forward};
}

Ray moved(const Ray& ray, const Mat4& by) {
  return {by.point(ray.origin), by.direction(ray.direction)};
}

Mat4 turn_back(double degrees) {
  const double c = cos_deg(degrees), s = sin_deg(degrees);
  Mat4 turn;
  turn.m = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return turn;
}

bool is_inside(const RayTree& tree, Vec3d p) {
  // Of no special direction, so that edges and faces of things made by hand are not met along them.
  constexpr std::array<Vec3d, 3> k_directions{
      Vec3d{0.5377, 0.2113, 0.8162}, {-0.7411, 0.6301, 0.2318}, {0.1713, -0.9127, -0.3711}};
  return std::all_of(k_directions.begin(), k_directions.end(),
                     [&](Vec3d direction) { return tree.crossings(p, direction) % 2 == 1; });
}

/// A length by which a matrix that turns, scales and moves makes lengths grow.
double scale_of(const Mat4& m) {
  return length(m.direction({1, 0, 0}));
}

/// Where a light stands; nothing for one that is everywhere or very far.
std::optional<Vec3d> place_of(const Light& light) {
  for (const kernels::LightInput& input : type_of(light).host.inputs)
    if (input.value == kernels::LightValue::point)
      return to_double(light_vector(light, input.name));
  return std::nullopt;
}

/// Of where lights stand; "" where none stands anywhere.
std::string canonical_places(const std::vector<Light>& lights) {
  CanonicalText text;
  for (const Light& light : lights)
    if (const auto place = place_of(light)) {
      const double numbers[] = {place->x, place->y, place->z};
      text.add(light.name, std::span<const double>(numbers));
    }
  return text.text();
}

std::string text_of(const Rejection& rejection) {
  return fmt::format("{} {}", rejection.value, rejection.condition);
}

std::optional<Rejection> rejection_from(const std::string& text) {
  Rejection rejection;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), rejection.value);
  if (error != std::errc() || end == text.data() + text.size()) return std::nullopt;
  rejection.condition = text.substr(static_cast<std::size_t>(end - text.data()) + 1);
  return rejection;
}

}  // namespace

Rejection ViewConditions::reject(const ImageSpec& image) {
  const KeepSettings& keep = recipe_.keep;
  CanonicalText text;
  text.add("in_frame", keep.in_frame);
  text.add("visible", keep.visible);
  text.add("clearance_m", keep.clearance_m);
  text.add("width", image.engine.width);
  text.add("height", image.engine.height);
  text.add("environment", inputs_.environment_facts(image.environment_folder).shapes.at(0));
  const std::string question =
      "keep " +
      hash_text(text.text() + canonical_turn(turn_of(image)) + canonical_camera(image.camera) +
                canonical_model(inputs_.model_hashes(image.model_file), {},
                                normalise_of(image, recipe_)) +
                DistractorTexts(recipe_, inputs_).of_plane(image, plane_type("mask")) +
                (keep.clearance_m > 0 ? canonical_places(image.lights) : ""))
          .hex();
  if (const auto known = inputs_.find_known(question))
    if (const auto rejection = rejection_from(*known)) return *rejection;
  Rejection rejection = look(image);
  inputs_.keep_known(question, text_of(rejection));
  return rejection;
}

const RayTree& ViewConditions::around(const ImageSpec& image) {
  const auto [at, is_new] = environments_.try_emplace(*image.environment_folder);
  if (!is_new) return at->second;
  std::vector<std::array<Vec3, 3>> triangles;
  for (const Object& object : inputs_.environment(image.environment_folder).objects) {
    if (object.camera_invisible) continue;
    const auto own = triangles_of(object.mesh);
    triangles.insert(triangles.end(), own.begin(), own.end());
  }
  return at->second = RayTree(std::move(triangles));
}

ViewConditions::PlacedModel ViewConditions::placed(const std::filesystem::path& file,
                                                   NormaliseOptions options) {
  options.turn = NormaliseOptions{}.turn;
  options.place_m = {};
  return {file, options, RayTree(triangles_of(inputs_.model_mesh(file, options))),
          model_to_world(inputs_.model_extent(file), options)};
}

const ViewConditions::PlacedModel& ViewConditions::model_of(const ImageSpec& image) {
  NormaliseOptions still = normalise_of(image, recipe_);
  still.turn = NormaliseOptions{}.turn;
  still.place_m = {};
  if (model_ && model_->file == *image.model_file && model_->options == still) return *model_;
  model_.reset();
  model_ = std::make_unique<PlacedModel>(placed(image.model_file, still));
  return *model_;
}

/// In one size for all images, each then by a matrix of its own.
std::vector<ViewConditions::Hider> ViewConditions::hiders_of(const ImageSpec& image) {
  std::vector<Hider> hiders;
  if (others_.size() > k_most_trees) others_.clear();
  for (const Distractor& one : *image.distractors) {
    const NormaliseOptions options = normalise_of(one, recipe_);
    auto at = others_.find(one.model.file->native());
    if (at == others_.end()) {
      NormaliseOptions unit = options;
      unit.size_m = 1;
      at = others_.emplace(one.model.file->native(), placed(one.model.file, unit)).first;
    }
    const Mat4 to_world = model_to_world(inputs_.model_extent(one.model.file), options, one.lowest);
    hiders.push_back({one.model.file->native(), at->second.to_world * portable::inverse(to_world)});
  }
  return hiders;
}

double ViewConditions::in_frame(const ImageSpec& image) {
  ImageRecord record;
  const double scale =
      std::min(1.0, double{k_most_pixels} / std::max(image.engine.width, image.engine.height));
  record.width = std::max(1, static_cast<int>(image.engine.width * scale));
  record.height = std::max(1, static_cast<int>(image.engine.height * scale));
  if (type_of(image.camera).host.span == kernels::CameraSpan::fov_deg)
    record.intrinsics = camera_intrinsics(image.camera.fov_deg, record.width, record.height);
  else
    record.metres_per_pixel = image.camera.extent_m / std::max(record.width, record.height);
  record.camera_to_world = camera_pose(image.camera);
  const MeshExtent& extent = inputs_.model_extent(image.model_file);
  record.pose = {model_to_world(extent, normalise_of(image, recipe_), image.lowest).m, extent.box};
  const auto counts = count_beyond(
      record, [&]() -> const FileMesh& { return inputs_.model_file_mesh(image.model_file); });
  if (counts->beyond == 0 && !counts->whole) return 1;
  if (counts->whole == 0) return 0;
  return 1 - static_cast<double>(*counts->beyond) / static_cast<double>(*counts->whole);
}

Rejection ViewConditions::look(const ImageSpec& image) {
  const KeepSettings& keep = recipe_.keep;
  if (keep.in_frame > 0)
    if (const double share = in_frame(image); share < keep.in_frame) return {"in_frame", share};
  const PlacedModel& model = model_of(image);
  const Mat4 to_world = model_to_world(inputs_.model_extent(image.model_file),
                                       normalise_of(image, recipe_), image.lowest);
  const Mat4 to_model = model.to_world * portable::inverse(to_world);
  const Mat4 to_environment = turn_back(turn_of(image));
  const RayTree& environment = around(image);
  const Vec3d camera = image.camera.position;
  if (is_inside(model.tree, to_model.point(camera))) return {"inside", 0};
  if (keep.clearance_m > 0) {
    const double scale = scale_of(to_model);
    const auto nearest = [&](Vec3d p) {
      return environment.distance(
          to_environment.point(p),
          model.tree.distance(to_model.point(p), keep.clearance_m * scale) / scale);
    };
    if (const double found = nearest(camera); found < keep.clearance_m)
      return {"clearance_m", found};
    for (const Light& light : *image.lights) {
      const auto place = place_of(light);
      if (!place) continue;
      if (is_inside(model.tree, to_model.point(*place))) return {"clearance_m", 0};
      if (const double found = nearest(*place); found < keep.clearance_m)
        return {"clearance_m", found};
    }
  }
  if (!(keep.visible > 0)) return {};
  const std::array<double, 16> pose = camera_pose(image.camera);
  constexpr double k_far = std::numeric_limits<double>::max();
  // A thing that stands on another touches it.
  constexpr double k_before = 1 - 1e-6;
  const std::vector<Hider> hiders = hiders_of(image);
  const auto hidden = [&](const Ray& ray, double before) {
    return std::any_of(hiders.begin(), hiders.end(), [&](const Hider& hider) {
      const Ray at_hider = moved(ray, hider.to_tree);
      return others_.at(hider.file).tree.nearest(at_hider.origin, at_hider.direction, before) <
             before;
    });
  };
  std::uint64_t whole = 0, seen = 0;
  for (int y = 0; y < k_rays; ++y)
    for (int x = 0; x < k_rays; ++x) {
      const Ray ray =
          ray_through(image.camera, pose, image.engine.width, image.engine.height, x, y);
      const Ray at_model = moved(ray, to_model), at_environment = moved(ray, to_environment);
      const double t = model.tree.nearest(at_model.origin, at_model.direction, k_far);
      if (t == k_far) continue;
      ++whole;
      const double before = t * k_before;
      if (environment.nearest(at_environment.origin, at_environment.direction, before) == before &&
          !hidden(ray, before))
        ++seen;
    }
  const double share = whole == 0 ? 0 : static_cast<double>(seen) / static_cast<double>(whole);
  if (share < keep.visible) return {"visible", share};
  return {};
}

}  // namespace ds

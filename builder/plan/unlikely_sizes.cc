// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/unlikely_sizes.h"

#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace ds {
namespace {

Vec3d side_of(const Box& box) {
  return box.most - box.least;
}
double longest(Vec3d side) {
  return std::max({side.x, side.y, side.z});
}
Vec3d middle_of(const Box& box) {
  return (box.least + box.most) * 0.5;
}

/// The camera's axes; `forward` is what it looks along.
struct Axes {
  Vec3d right, up, forward;
};
Axes axes_of(const Camera& camera) {
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up));
  return {right, cross(right, forward), forward};
}

ShownSides shown_by(const ImageLengths& image) {
  return shown_by(image.camera, image.width, image.height);
}

bool is_camera_inside(const ImageLengths& image) {
  const Vec3d p = image.camera.position;
  const Box& box = image.model;
  return p.x > box.least.x && p.x < box.most.x && p.y > box.least.y && p.y < box.most.y &&
         p.z > box.least.z && p.z < box.most.z;
}

/// Whether all corners of the box are outside of one side of what the camera sees, or behind it.
bool is_out_of_view(const ImageLengths& image) {
  const Axes axes = axes_of(image.camera);
  const ShownSides sides = shown_by(image);
  std::array<bool, 5> outside{true, true, true, true, true};
  for (int corner = 0; corner < 8; ++corner) {
    const auto pick = [&](int bit, double least, double most) {
      return (corner >> bit & 1) == 0 ? least : most;
    };
    const Box& box = image.model;
    const Vec3d at = Vec3d{pick(0, box.least.x, box.most.x), pick(1, box.least.y, box.most.y),
                           pick(2, box.least.z, box.most.z)} -
                     image.camera.position;
    // A lens sees a little around its middle.
    const double lens = image.camera.lens_radius_m * 2;
    const double x = dot(at, axes.right), y = dot(at, axes.up), z = dot(at, axes.forward);
    const double half_width = sides.x_m + z * sides.x_per_metre;
    const double half_height = sides.y_m + z * sides.y_per_metre;
    const std::array<double, 5> beyond{x - half_width, -x - half_width, y - half_height,
                                       -y - half_height, -z};
    for (std::size_t plane = 0; plane < beyond.size(); ++plane)
      outside[plane] = outside[plane] && beyond[plane] > lens;
  }
  return std::any_of(outside.begin(), outside.end(), [](bool all) { return all; });
}

double distance_to(const ImageLengths& image) {
  return length(middle_of(image.model) - image.camera.position);
}

/// How much of a length the picture shows at the model's distance.
double shown_m(const ImageLengths& image) {
  const ShownSides sides = shown_by(image);
  const double away_m = distance_to(image);
  return 2 *
         std::max(sides.x_m + away_m * sides.x_per_metre, sides.y_m + away_m * sides.y_per_metre);
}

/// Angles of view in radians are below pi. One so narrow is for what is far.
bool is_narrow(const ImageLengths& image) {
  constexpr double k_parts = 4;
  return type_of(image.camera).host.span == kernels::CameraSpan::fov_deg &&
         image.camera.fov_deg < std::numbers::pi &&
         longest(side_of(image.model)) > k_parts * shown_m(image);
}

bool is_tiny(const ImageLengths& image) {
  constexpr double k_pixels = 2;
  const double pixels =
      std::max(image.width, image.height) * longest(side_of(image.model)) / shown_m(image);
  return pixels < k_pixels;
}

/// A value of the recipe as it stands there; nothing where it has no such key.
std::optional<std::string> setting(const Recipe& recipe, std::string_view key) {
  for (const auto& [name, value] : recipe.settings)
    if (name == key) return value;
  return std::nullopt;
}

/// Asks after the unit of a length that is large for a thing on a table, else names the unit.
std::string unit_of(std::string_view key, double length_m) {
  constexpr double k_large_m = 1;
  return length_m >= k_large_m
             ? fmt::format("is {} = {:g} in millimetres? lengths are in metres", key, length_m)
             : fmt::format("{} = {:g} is in metres", key, length_m);
}

std::string unit_of_model(double size_m) {
  if (size_m > 0) return unit_of("models.size_m", size_m);
  return "models.size_m = 0 takes the model file's lengths as metres";
}

std::string unit_of_distance(const Recipe& recipe, const Camera& camera) {
  if (recipe.camera_fit)
    return "camera.distance_m = \"fit\" has both it and camera.target in the picture: "
           "models.ground_z_m "
           "and models.centre, which place it, are in metres";
  if (!setting(recipe, "camera.distance_m")) return "camera.positions are in metres";
  return unit_of("camera.distance_m", length(camera.position - camera.target));
}

std::string unit_of_focus(const Recipe& recipe, double focus_m) {
  if (setting(recipe, "camera.focus_distance_m"))
    return unit_of("camera.focus_distance_m", focus_m);
  return fmt::format("camera.focus = {} has it there",
                     setting(recipe, "camera.focus").value_or("\"origin\""));
}

/// With the figures of one image, the first of its kind.
std::string describe(UnlikelySize what, const ImageLengths& image, const Recipe& recipe,
                     double size_m) {
  const double model_m = longest(side_of(image.model)), distance_m = distance_to(image);
  const Camera& camera = image.camera;
  switch (what) {
    case UnlikelySize::camera_inside:
      return fmt::format(
          "the camera stands inside the model's bounding box: the model is {:.4g} m long, the "
          "camera {:.4g} m from what it looks at; {}",
          model_m, length(camera.position - camera.target),
          model_m >= 1 ? unit_of_model(size_m) : unit_of_distance(recipe, camera));
    case UnlikelySize::model_large:
      return fmt::format(
          "the model is far larger than its environment: {:.4g} m long, all objects there {:.4g} "
          "m; {}",
          model_m, image.environment_m, unit_of_model(size_m));
    case UnlikelySize::view_narrow:
      return fmt::format(
          "the picture shows {:.2g} m of a model of {:.4g} m: is camera.fov_deg = {:g} in radians? "
          "it "
          "is in degrees, {:.4g} of them",
          shown_m(image), model_m, camera.fov_deg, camera.fov_deg * 180 / std::numbers::pi);
    case UnlikelySize::out_of_view:
      return fmt::format(
          "nothing of the model is in front of the camera: it is {:.4g} m long, its middle {:.4g} "
          "m "
          "away and off the picture; see camera.target, models.centre and models.ground_z_m, which "
          "are in metres",
          model_m, distance_m);
    case UnlikelySize::model_tiny:
      return fmt::format(
          "the model is smaller than two pixels: it is {:.4g} m long and {:.4g} m away; {}",
          model_m, distance_m,
          distance_m >= 1 ? unit_of_distance(recipe, camera) : unit_of_model(size_m));
    case UnlikelySize::lens_wide:
      return fmt::format(
          "the lens is too wide to show the model: its radius is {:.4g} m, the model {:.4g} m long "
          "and {:.4g} m away; {}",
          camera.lens_radius_m, model_m, distance_m,
          unit_of("camera.lens_radius_m", camera.lens_radius_m));
    case UnlikelySize::out_of_focus:
      return fmt::format(
          "the model is far from what is in focus: it is {:.4g} m away, the plane in focus {:.4g} "
          "m; {}",
          distance_m, camera.focus_distance_m, unit_of_focus(recipe, camera.focus_distance_m));
  }
  DS_ASSERT(false);
  return "";
}

/// How many images, and the first few, by what is wrong with them.
struct Found {
  Concern images;
  std::string text;
};

class Finder {
 public:
  Finder(const Recipe& recipe, Inputs& inputs) : recipe_(recipe), inputs_(inputs) {}

  void look(const ImageSpec& spec, Concern& all) {
    const ImageLengths image = lengths_of(spec);
    const auto place = unlikely_place(image);
    // Where the model is not what the camera is for, the lens does not fit it either.
    const bool fits = !place || *place == UnlikelySize::model_large;
    const auto lens = fits ? unlikely_lens(image) : std::nullopt;
    ++all.of;
    if (place || lens) add_example(all, spec.id);
    for (const auto& what : {place, lens})
      if (what) add(*what, image, spec.id);
  }

  std::vector<std::string> lines(std::size_t of) const {
    std::vector<std::string> lines;
    for (const auto& [what, found] : found_) {
      const Concern& images = found.images;
      std::string names = fmt::format("{}", fmt::join(images.examples, ", "));
      if (images.count > images.examples.size())
        names += fmt::format(" and {} more", images.count - images.examples.size());
      lines.push_back(fmt::format("{} of {} images ({}): {}", images.count, of, names, found.text));
    }
    return lines;
  }

 private:
  void add(UnlikelySize what, const ImageLengths& image, const std::string& id) {
    Found& found = found_[what];
    if (found.text.empty()) found.text = describe(what, image, recipe_, options_.size_m);
    add_example(found.images, id);
  }

  ImageLengths lengths_of(const ImageSpec& spec) {
    const NormaliseOptions options = normalise_of(spec, recipe_);
    if (!model_.is_same(spec.model_file) || options != options_) {
      box_ = normalised_box(inputs_.model_extent(spec.model_file), options, spec.lowest);
      model_ = spec.model_file;
      options_ = options;
    }
    return {spec.camera, spec.engine.width, spec.engine.height, box_,
            inputs_.environment_facts(spec.environment_folder).longest_side_m};
  }

  const Recipe& recipe_;
  Inputs& inputs_;
  Shared<std::filesystem::path> model_;  // of the image before: a model's images follow each other
  NormaliseOptions options_;
  Box box_;
  std::map<UnlikelySize, Found> found_;
};

}  // namespace

std::optional<UnlikelySize> unlikely_place(const ImageLengths& image) {
  // A turntable or a cloth under the model may be smaller than it; a room is not.
  constexpr double k_larger = 4;
  if (is_camera_inside(image)) return UnlikelySize::camera_inside;
  if (image.environment_m > 0 && longest(side_of(image.model)) > k_larger * image.environment_m)
    return UnlikelySize::model_large;
  if (is_narrow(image)) return UnlikelySize::view_narrow;
  if (is_out_of_view(image)) return UnlikelySize::out_of_view;
  if (is_tiny(image)) return UnlikelySize::model_tiny;
  return std::nullopt;
}

std::optional<UnlikelySize> unlikely_lens(const ImageLengths& image) {
  constexpr double k_far = 100;
  const double radius_m = image.camera.lens_radius_m, model_m = longest(side_of(image.model));
  if (radius_m == 0) return std::nullopt;
  const double distance_m = distance_to(image), focus_m = image.camera.focus_distance_m;
  // The fastest lenses there are have a radius of half the distance at which they still focus; one
  // wider than the model is for what is small and far.
  if (radius_m * 2 > distance_m || (radius_m * 2 > model_m && radius_m * 10 > distance_m))
    return UnlikelySize::lens_wide;
  // A point at distance d is smeared over 2 r |d - f| / f there.
  const double smeared_m = 2 * radius_m * std::abs(distance_m - focus_m) / focus_m;
  if (focus_m > k_far * distance_m || focus_m * k_far < distance_m || smeared_m > model_m)
    return UnlikelySize::out_of_focus;
  return std::nullopt;
}

Concern find_unlikely_sizes(const Recipe& recipe, const std::vector<PlannedImage>& images,
                            Inputs& inputs, std::vector<std::string>& lines) {
  Concern all{"sizes_unlikely", 0, 0, {}};
  Finder finder(recipe, inputs);
  for (const PlannedImage& image : images)
    if (!image.error) finder.look(image.spec, all);
  lines = finder.lines(all.of);
  return all;
}

}  // namespace ds

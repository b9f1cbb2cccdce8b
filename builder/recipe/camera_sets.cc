// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/camera_sets.h"

#include "manifests/camera_geometry.h"
#include "tracer/base/log.h"
#include "tracer/scene/type_tables.h"

#include <cmath>
#include <set>

namespace ds {
namespace {

// 360 (1 - 1 / golden ratio) degrees: successive points of the spiral never line up.
constexpr double k_golden_angle_deg = 137.50776405003785;

// Below this sine between the view and +Z there is no direction to call right.
constexpr double k_least_sine = 1e-6;

constexpr std::string_view k_views = "camera.views";

Vec3d point_of(const RecipeValue& value) {
  const auto& list = *value.array();
  return {list[0].number(), list[1].number(), list[2].number()};
}

std::vector<Vec3d> offset_by(std::vector<Vec3d> positions, Vec3d offset) {
  for (Vec3d& position : positions)
    position = position + offset;
  return positions;
}

std::vector<Vec3d> listed_positions(const Settings& settings) {
  std::vector<Vec3d> positions;
  if (const RecipeValue* list = settings.find("camera.positions")) {
    for (const RecipeValue& point : *list->array())
      positions.push_back(point_of(point));
  }
  // Keys of another set say that this one was not meant.
  if (positions.empty() && !settings.misfits("camera.set") &&
      (settings.find("camera.positions") != nullptr || !settings.given("camera.positions"))) {
    settings.complain("camera.positions", "must hold a position with camera.set = \"list\"");
  }
  return positions;
}

bool is_fit(const Settings& settings) {
  return settings.text("camera.set") != "list" &&
         settings.literal("camera.distance_m") == "\"fit\"";
}

std::optional<CameraFit> fit_of(const Settings& settings) {
  if (!is_fit(settings)) return std::nullopt;
  // The table's vectors have lengths of their own: there is no one distance to choose.
  if (settings.text("camera.set") == "half-dodecahedron" && !settings.boolean("camera.normalise"))
    settings.complain("camera.normalise", "must be true with camera.distance_m = \"fit\"");
  if (settings.given("camera.extent_m") && !settings.misfits("camera.type"))
    settings.complain("camera.extent_m",
                      "must not be given with camera.distance_m = \"fit\", which chooses it");
  CameraFit fit;
  fit.margin = settings.number("camera.fit_margin");
  const std::string& focus = settings.text("camera.focus");
  fit.focus = focus == "distance" ? CameraFit::Focus::distance
              : focus == "target" ? CameraFit::Focus::target
                                  : CameraFit::Focus::origin;
  return fit;
}

std::vector<Vec3d> positions_of(const Settings& settings, Vec3d target) {
  const std::string& set = settings.text("camera.set");
  if (set == "list") return listed_positions(settings);
  const double distance_m = is_fit(settings) ? 1 : settings.number("camera.distance_m");
  if (set == "half-dodecahedron") {
    return offset_by(half_dodecahedron(distance_m, settings.boolean("camera.normalise")), target);
  }
  const int count = settings.integer("camera.count");
  const double azimuth_deg = settings.number("camera.azimuth_deg");
  if (set == "orbit") {
    return offset_by(orbit(count, distance_m, settings.number("camera.elevation_deg"), azimuth_deg),
                     target);
  }
  DS_ASSERT(set == "hemisphere");
  return offset_by(hemisphere(count, distance_m, azimuth_deg), target);
}

/// The numbers of the views to use, ascending.
std::set<std::size_t> chosen_views(const Settings& settings, std::size_t count) {
  std::set<std::size_t> chosen;
  const RecipeValue& views = *settings.find(k_views);
  for (const RecipeValue& view : *views.array()) {
    const auto number = static_cast<std::size_t>(*view.integer());
    if (number >= count) {
      settings.complain(
          view, k_views,
          fmt::format("must be below the {} views of the set, got {}", count, number));
    } else if (!chosen.insert(number).second) {
      settings.complain(view, k_views, fmt::format("must name a view once, got {} again", number));
    }
  }
  if (views.array()->empty()) {
    for (std::size_t i = 0; i < count; ++i)
      chosen.insert(i);
  }
  return chosen;
}

/// Sets what lies along the viewing axis: up and focus. False, and a finding, where it cannot.
bool aim(const Settings& settings, const std::string& name, Camera& camera) {
  const Vec3d forward = normalized(camera.target - camera.position);
  if (length(forward) == 0) {
    settings.complain("camera.target",
                      fmt::format("must not be where a camera stands, got view {} there", name));
    return false;
  }
  if (length(cross(forward, camera.up)) < k_least_sine) camera.up = {0, 1, 0};
  const std::string& focus = settings.text("camera.focus");
  if (focus == "distance") {
    if (const RecipeValue* distance = settings.find("camera.focus_distance_m")) {
      camera.focus_distance_m = distance->number();
    }
    return true;
  }
  if (is_fit(settings)) return true;  // the distance is each model's: see fit_camera
  const Vec3d sharp = focus == "target" ? camera.target : Vec3d{};
  camera.focus_distance_m = dot(sharp - camera.position, forward);
  if (camera.focus_distance_m > 0) return true;
  if (camera.lens_radius_m == 0) {  // sharp everywhere: any distance does
    camera.focus_distance_m = length(camera.target - camera.position);
    return true;
  }
  settings.complain(
      "camera.focus",
      fmt::format("must be in front of every camera, got {} m for view {}; \"target\" "
                  "always is",
                  camera.focus_distance_m, name));
  return false;
}

/// Says that a focus is chosen for a pinhole.
void warn_of_idle_focus(const Settings& settings) {
  const RecipeValue* focus = settings.find("camera.focus");
  if (settings.number("camera.lens_radius_m") > 0 || !settings.given("camera.focus") ||
      settings.text("camera.focus") == "origin")
    return;
  warn(
      fmt::format("{}: camera.focus has no effect with camera.lens_radius_m = 0, a pinhole: all "
                  "is sharp",
                  to_string(focus->place)));
}

}  // namespace

std::vector<Vec3d> half_dodecahedron(double distance_m, bool normalise) {
  static constexpr Vec3d k_table[] = {
      {1.618, 0, 0},     {.618, 1.618, 0}, {-.618, 1.618, 0}, {-1.618, 0, 0},   {-.618, -1.618, 0},
      {.618, -1.618, 0}, {1.618, 0, .618}, {1, 1, 1},         {-1, 1, 1},       {-1.618, 0, .618},
      {-1, -1, 1},       {1, -1, 1},       {0, .618, 1.618},  {0, -.618, 1.618}};
  std::vector<Vec3d> positions;
  for (const Vec3d& v : k_table)
    positions.push_back(v * (distance_m / (normalise ? length(v) : 1.732)));
  return positions;
}

std::vector<Vec3d> orbit(int count, double distance_m, double elevation_deg, double azimuth_deg) {
  const double radius = distance_m * cos_deg(elevation_deg);
  const double z = distance_m * sin_deg(elevation_deg);
  std::vector<Vec3d> positions;
  for (int i = 0; i < count; ++i) {
    const double azimuth = azimuth_deg + 360.0 * i / count;
    positions.push_back({radius * cos_deg(azimuth), radius * sin_deg(azimuth), z});
  }
  return positions;
}

std::vector<Vec3d> hemisphere(int count, double distance_m, double azimuth_deg) {
  std::vector<Vec3d> positions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (i + 0.5) / count;
    const double radius = std::sqrt(1.0 - z * z);
    const double azimuth = azimuth_deg + std::fmod(i * k_golden_angle_deg, 360.0);
    positions.push_back(distance_m *
                        Vec3d{radius * cos_deg(azimuth), radius * sin_deg(azimuth), z});
  }
  return positions;
}

CameraViews make_cameras(const Settings& settings) {
  warn_of_idle_focus(settings);
  if (settings.text("camera.focus") == "distance" && !settings.given("camera.focus_distance_m")) {
    settings.complain("camera.focus_distance_m", "must be given with camera.focus = \"distance\"");
  }
  const Vec3d target = point_of(*settings.find("camera.target"));
  const std::vector<Vec3d> positions = positions_of(settings, target);
  CameraViews views;
  views.fit = fit_of(settings);
  for (const std::size_t i : chosen_views(settings, positions.size())) {
    Camera camera;
    camera.position = positions[i];
    camera.target = target;
    camera.type = find_camera_type(settings.text("camera.type"));
    span_of(camera) = settings.number(fmt::format("camera.{}", type_of(camera).span_name()));
    camera.lens_radius_m = settings.number("camera.lens_radius_m");
    views.names.push_back(std::to_string(i));
    views.cameras.push_back(camera);
    if (!aim(settings, views.names.back(), views.cameras.back()))
      break;  // the others would say the same
  }
  return views;
}

}  // namespace ds

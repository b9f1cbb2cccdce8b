// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/camera_sets.h"

#include "manifests/camera_geometry.h"
#include "tracer/base/log.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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

Vec3d vector_of(const std::array<double, 3>& point) {
  return {point[0], point[1], point[2]};
}

constexpr Vec3d k_dodecahedron[] = {
    {1.618, 0, 0},     {.618, 1.618, 0}, {-.618, 1.618, 0}, {-1.618, 0, 0},   {-.618, -1.618, 0},
    {.618, -1.618, 0}, {1.618, 0, .618}, {1, 1, 1},         {-1, 1, 1},       {-1.618, 0, .618},
    {-1, -1, 1},       {1, -1, 1},       {0, .618, 1.618},  {0, -.618, 1.618}};

Vec3d on_dodecahedron(std::size_t i, double distance_m, bool normalise) {
  const Vec3d& v = k_dodecahedron[i];
  return v * (distance_m / (normalise ? length(v) : 1.732));
}

Vec3d on_orbit(std::size_t i, int count, double distance_m, double elevation_deg,
               double azimuth_deg) {
  const double radius = distance_m * cos_deg(elevation_deg);
  const double azimuth = azimuth_deg + 360.0 * static_cast<double>(i) / count;
  return {radius * cos_deg(azimuth), radius * sin_deg(azimuth),
          distance_m * sin_deg(elevation_deg)};
}

Vec3d on_hemisphere(std::size_t i, int count, double distance_m, double azimuth_deg) {
  const double number = static_cast<double>(i), z = 1.0 - (number + 0.5) / count;
  const double radius = std::sqrt(1.0 - z * z);
  const double azimuth = azimuth_deg + std::fmod(number * k_golden_angle_deg, 360.0);
  return distance_m * Vec3d{radius * cos_deg(azimuth), radius * sin_deg(azimuth), z};
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
  return settings.applies(*find_key("camera.distance_m")) &&
         settings.literal("camera.distance_m") == "\"fit\"";
}

CameraFit::Focus focus_of(const Settings& settings) {
  const std::string& focus = settings.text("camera.focus");
  return focus == "distance" ? CameraFit::Focus::distance
         : focus == "target" ? CameraFit::Focus::target
                             : CameraFit::Focus::origin;
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
  fit.focus = focus_of(settings);
  return fit;
}

CameraSet read_set(const Settings& settings) {
  CameraSet set;
  constexpr std::array<std::string_view, 5> k_kinds = {"half-dodecahedron", "list", "orbit",
                                                       "hemisphere", "random"};
  const auto kind = std::find(k_kinds.begin(), k_kinds.end(), settings.text("camera.set"));
  DS_ASSERT(kind != k_kinds.end());
  set.kind = static_cast<CameraSet::Kind>(kind - k_kinds.begin());
  set.count = settings.integer("camera.count");
  set.normalise = settings.boolean("camera.normalise");
  if (set.kind == CameraSet::Kind::list) set.positions = listed_positions(settings);
  if (set.kind == CameraSet::Kind::random && !settings.given("camera.position_m"))
    settings.complain("camera.position_m", "must be given with camera.set = \"random\"");
  set.type = find_camera_type(settings.text("camera.type"));
  set.focus = focus_of(settings);
  set.fits = is_fit(settings);
  return set;
}

std::size_t view_count(const CameraSet& set) {
  if (set.kind == CameraSet::Kind::half_dodecahedron) return std::size(k_dodecahedron);
  if (set.kind == CameraSet::Kind::list) return set.positions.size();
  return static_cast<std::size_t>(set.count);
}

Vec3d position_of(const CameraSet& set, const Variables& v, std::size_t i) {
  const Vec3d target = vector_of(v.target);
  switch (set.kind) {
    case CameraSet::Kind::half_dodecahedron:
      return on_dodecahedron(i, v.distance_m, set.normalise) + target;
    case CameraSet::Kind::list:
      return set.positions[i];
    case CameraSet::Kind::orbit:
      return on_orbit(i, set.count, v.distance_m, v.elevation_deg, v.azimuth_deg) + target;
    case CameraSet::Kind::hemisphere:
      return on_hemisphere(i, set.count, v.distance_m, v.azimuth_deg) + target;
    case CameraSet::Kind::random:
      break;
  }
  return vector_of(v.position_m) + target;
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

/// Says that a focus is chosen for a pinhole.
void warn_of_idle_focus(const Settings& settings, double lens_radius_m) {
  const RecipeValue* focus = settings.find("camera.focus");
  if (lens_radius_m > 0 || settings.distribution("camera.lens_radius_m") != nullptr ||
      !settings.given("camera.focus") || settings.text("camera.focus") == "origin")
    return;
  warn(
      fmt::format("{}: camera.focus has no effect with camera.lens_radius_m = 0, a pinhole: all "
                  "is sharp",
                  to_string(focus->place)));
}

}  // namespace

std::vector<Vec3d> half_dodecahedron(double distance_m, bool normalise) {
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i < std::size(k_dodecahedron); ++i)
    positions.push_back(on_dodecahedron(i, distance_m, normalise));
  return positions;
}

std::vector<Vec3d> orbit(int count, double distance_m, double elevation_deg, double azimuth_deg) {
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    positions.push_back(on_orbit(i, count, distance_m, elevation_deg, azimuth_deg));
  return positions;
}

std::vector<Vec3d> hemisphere(int count, double distance_m, double azimuth_deg) {
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    positions.push_back(on_hemisphere(i, count, distance_m, azimuth_deg));
  return positions;
}

Camera camera_of(const CameraSet& set, const Variables& variables, std::size_t number) {
  Camera camera;
  camera.position = position_of(set, variables, number);
  camera.target = vector_of(variables.target);
  camera.type = set.type;
  span_of(camera) = variables.span;
  camera.lens_radius_m = variables.lens_radius_m;
  const Vec3d forward = normalized(camera.target - camera.position);
  if (length(cross(forward, camera.up)) < k_least_sine) camera.up = {0, 1, 0};
  if (variables.roll_deg != 0) {
    const Vec3d right = normalized(cross(forward, camera.up));
    camera.up =
        cross(right, forward) * cos_deg(variables.roll_deg) + right * sin_deg(variables.roll_deg);
  }
  if (set.focus == CameraFit::Focus::distance) {
    camera.focus_distance_m = variables.focus_distance_m;
    return camera;
  }
  if (set.fits) return camera;  // the distance is each model's: see fit_camera
  const Vec3d sharp = set.focus == CameraFit::Focus::target ? camera.target : Vec3d{};
  camera.focus_distance_m = dot(sharp - camera.position, forward);
  // A pinhole is sharp everywhere: any distance does.
  if (camera.focus_distance_m <= 0 && camera.lens_radius_m == 0)
    camera.focus_distance_m = length(camera.target - camera.position);
  return camera;
}

std::optional<CameraFault> fault_of(const CameraSet& set, const Camera& camera,
                                    std::string_view view) {
  if (length(camera.target - camera.position) == 0)
    return CameraFault{"camera.target",
                       fmt::format("must not be where a camera stands, got view {} there", view)};
  if (set.focus == CameraFit::Focus::distance || set.fits || camera.focus_distance_m > 0)
    return std::nullopt;
  return CameraFault{
      "camera.focus",
      fmt::format("must be in front of every camera, got {} m for view {}; \"target\" always is",
                  camera.focus_distance_m, view)};
}

CameraViews make_cameras(const Settings& settings, const Variables& constants) {
  warn_of_idle_focus(settings, constants.lens_radius_m);
  if (settings.text("camera.focus") == "distance" && !settings.given("camera.focus_distance_m")) {
    settings.complain("camera.focus_distance_m", "must be given with camera.focus = \"distance\"");
  }
  CameraViews views;
  views.set = read_set(settings);
  views.fit = fit_of(settings);
  const bool drawn =
      std::any_of(variable_keys().begin(), variable_keys().end(), [&](const VariableKey& row) {
        return row.key.starts_with("camera.") && settings.distribution(row.key) != nullptr;
      });
  bool complained = drawn || (views.set.kind == CameraSet::Kind::random &&
                              settings.find("camera.position_m") == nullptr);
  for (const std::size_t i : chosen_views(settings, view_count(views.set))) {
    views.names.push_back(std::to_string(i));
    views.cameras.push_back(camera_of(views.set, constants, i));
    if (complained) continue;  // the others would say the same
    if (const auto fault = fault_of(views.set, views.cameras.back(), views.names.back())) {
      settings.complain(fault->key, fault->message);
      complained = true;
    }
  }
  return views;
}

}  // namespace ds

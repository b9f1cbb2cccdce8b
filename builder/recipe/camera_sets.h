// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/camera_fit.h"
#include "builder/recipe/settings.h"
#include "tracer/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace ds {

struct CameraViews {
  std::vector<Camera> cameras;
  /// camera.distance_m = "fit": the cameras stand at 1 m, in the directions of the set.
  std::optional<CameraFit> fit;
  std::vector<std::string> names;  ///< "0", "1", ... in the set's order; as long as cameras
};

/// The cameras of a recipe's [camera]. The same bits on every machine. Up is +Z, or +Y for a camera
/// that looks straight up or down. Findings: no camera at all, one that stands on its target, one
/// behind which the plane in focus lies, a number in camera.views that the set has not.
CameraViews make_cameras(const Settings& settings);

/// Positions around the origin, in metres.
/// The 14 views of the thesis, around and above: corners of a dodecahedron's upper half and points
/// between them. `normalise`: all at the distance; else the table times distance / 1.732.
std::vector<Vec3d> half_dodecahedron(double distance_m, bool normalise);
/// `count` views at equal steps of azimuth on a circle, the first at azimuth_deg, counter-clockwise
/// seen from above.
std::vector<Vec3d> orbit(int count, double distance_m, double elevation_deg, double azimuth_deg);
/// `count` views spread evenly over the upper half of a sphere along a spiral from the pole down:
/// view k at height z = 1 - (k + 1/2) / count and azimuth_deg + k golden angles.
std::vector<Vec3d> hemisphere(int count, double distance_m, double azimuth_deg);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/camera_fit.h"
#include "builder/recipe/settings.h"
#include "builder/recipe/variables.h"
#include "tracer/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace ds {

/// [camera] but for its Variables.
struct CameraSet {
  enum class Kind { half_dodecahedron, list, orbit, hemisphere, random };

  Kind kind = Kind::half_dodecahedron;
  int count = 0;                 ///< of orbit, hemisphere and random
  bool normalise = true;         ///< of the half dodecahedron
  std::vector<Vec3d> positions;  ///< of the list
  int type = 0;                  ///< row of camera_types()
  CameraFit::Focus focus = CameraFit::Focus::origin;
  bool fits = false;  ///< what fit_camera makes of it counts
};

/// View `number` of the set: the same bits on every machine. Up is +Z, or +Y for a camera that looks
/// straight up or down, turned by the roll.
Camera camera_of(const CameraSet& set, const Variables& variables, std::size_t number);
/// What keeps a camera from seeing anything.
struct CameraFault {
  std::string_view key;  ///< "camera.target"
  std::string message;   ///< "must ..."
};
/// None where all is well.
std::optional<CameraFault> fault_of(const CameraSet& set, const Camera& camera,
                                    std::string_view view);

struct CameraViews {
  CameraSet set;
  /// With what is no constant as it stands by default.
  std::vector<Camera> cameras;
  /// camera.distance_m = "fit": the cameras stand at 1 m, in the directions of the set.
  std::optional<CameraFit> fit;
  std::vector<std::string> names;  ///< "0", "1", ... in the set's order; as long as cameras
};

/// The cameras of a recipe's [camera]. Findings: no camera at all, one that stands on its target, one
/// behind which the plane in focus lies (of those only where all is constant), a number in
/// camera.views that the set has not.
CameraViews make_cameras(const Settings& settings, const Variables& constants);

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

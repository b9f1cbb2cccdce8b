// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "tracer/render/film.h"
#include "tracer/render/render.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ds {

/// What one image's making took.
struct ImageWork {
  bool traced = false;        ///< film or planes
  bool developed = false;     ///< a picture was made from a film
  std::uint64_t samples = 0;  ///< traced now
};

/// What an image's files are made of: everything that needs the device is done.
struct TracedImage {
  const PlannedImage* image = nullptr;
  ImageWork work;
  /// Of each of the image's files: what the store has of it already.
  std::vector<std::optional<Product>> known;
  std::vector<bool> made_before;  ///< of each: an image given to the keeper before makes it too
  std::optional<Film> film;
  ToneMap tone_map;  ///< for the film
  bool new_film = false;
  FilmSums sums;  ///< to be kept; empty: none
  TraceRun film_run;
  std::vector<Plane> planes;  ///< planes_of the recipe, where any file is made of them
  TraceRun planes_run;
  /// Of each of the image's distractors: of the plane object_id and of its amodal mask, likewise.
  std::vector<ObjectCounts> objects;
  std::vector<Plane> light_planes;  ///< wanted_light_planes, likewise
  TraceRun light_run;
};

}  // namespace ds

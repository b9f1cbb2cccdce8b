// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/manifest_state.h"
#include "builder/plan/placed_files.h"
#include "manifests/concerns.h"

#include <functional>
#include <vector>

namespace ds {

/// What a build knows when it writes the manifest.
struct ManifestWork {
  const ListedImages& images;
  /// Whether this build made the image: what the database knows of it is newer than its line.
  std::function<bool(const PlannedImage&)> is_new;
  bool keep_all = false;  ///< the build was cut short: lines of images that it did not come to stay
  bool lines_hold = false;  ///< the lines that stand are as this dsbuild wrote them
};

struct WrittenManifest {
  std::vector<Concern> concerns;
  /// A line was taken over that the next build may leave out though nothing changed: of an image,
  /// or with a file, that the recipe does not have.
  bool left_over = false;
};

/// Writes the manifest: a line for each image that is made, and those of the manifest before that
/// are still true of images that are not. Lines that would be written again are taken over as they
/// stand, one after the other, so that a change of one model costs neither the reading of all that
/// is known of the others nor the memory for it. Throws Error(io).
WrittenManifest write_manifest(Dataset& dataset, const Plan& plan, PlacedFiles& placed,
                               const ManifestWork& work);

}  // namespace ds

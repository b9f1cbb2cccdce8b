// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/placed_files.h"
#include "builder/plan/plan.h"
#include "manifests/manifest.h"

#include <vector>

namespace ds {

/// Adds the lines that the manifest in the folder has for images which are not in place as the plan
/// wants them, where their files still are what those lines say: what cannot be made now is not
/// unwanted. `lacking`: those images of the plan; one whose picture is refused gets none. `all`:
/// lines of images that the plan does not have are kept too, since their files were not removed.
/// Classes and splits are the recipe's. Reads the manifest only where it may hold such lines.
void add_older_records(std::vector<ImageRecord>& records, const Dataset& dataset,
                       const std::vector<const PlannedImage*>& lacking, bool all,
                       PlacedFiles& placed);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "manifests/concerns.h"

#include "tracer/base/error.h"

#include <algorithm>

namespace ds {

std::vector<Concern> no_concerns() {
  std::vector<Concern> concerns;
  for (const char* name :
       {"mask_empty",       "mask_at_frame",         "mask_small",           "picture_black",
        "picture_white",    "models_absent",         "models_unlisted",      "entries_ambiguous",
        "classes_unshared", "classes_empty",         "splits_empty",         "assets_unphysical",
        "assets_unlikely",  "sizes_unlikely",        "names_by_case",        "meshes_damaged",
        "models_unlikely",  "own_materials_partial", "distractors_unplaced", "draws_idle"})
    concerns.push_back({name, 0, 0, {}});
  return concerns;
}

Concern& concern(std::vector<Concern>& concerns, const char* name) {
  const auto at = std::find_if(concerns.begin(), concerns.end(),
                               [&](const Concern& one) { return one.name == name; });
  DS_ASSERT(at != concerns.end());
  return *at;
}

void add_example(Concern& concern, const std::string& example) {
  ++concern.count;
  if (concern.examples.size() < k_concern_examples) concern.examples.push_back(example);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/placed_files.h"
#include "builder/plan/plan.h"

#include <array>
#include <optional>
#include <vector>

namespace ds {

/// Relative to the dataset's folder.
inline constexpr std::array<const char*, 3> k_manifest_files{
    "manifest/images.jsonl", "manifest/dataset.json", "manifest/checksums.xxh128"};

/// Hashes of what the manifest is written from, so that asking whether it is behind costs neither
/// its writing nor its reading. They stand as `product` of the manifest's files in the database.
struct ManifestSources {
  Hash128 listing;  ///< images.jsonl: the labels, and of the images listed the keys and files
  Hash128 labels;  ///< dataset.json: what is in no key: names, classes, splits, licences, settings;
                   ///< of all the plan's images, whether they are made or not
  Hash128 program;  ///< checksums.xxh128: the version of dsbuild that writes
};

/// Which images of a plan a manifest lists.
struct ListedImages {
  std::vector<const PlannedImage*> made;     ///< whose files are in place as the plan wants them
  std::vector<const PlannedImage*> lacking;  ///< the others: listed as the manifest before had them
  /// Of those, the ones that are still to come: the build was cut short before them, or they are
  /// another shard's. In the order of `lacking`.
  std::vector<const PlannedImage*> pending;
};

/// Of a plan but for its `labels` and `manifest`.
PlanLabels labels_of(const Recipe& recipe, const Plan& plan);

/// Lines taken over from the manifest before count by the bytes that are in their files' places: a
/// manifest that stands and was written from the same sources would be written again. Throws what
/// kept the plan's labels from being known.
ManifestSources manifest_sources(const Plan& plan, const ListedImages& images,
                                 const PlacedFiles& placed);

/// The same where every image of the dataset is made as the plan found it; nothing where not.
std::optional<ManifestSources> sources_as_planned(const Plan& plan);

/// Hash of what a build of the plan makes of the folder: which images of which keys and labels. The
/// same for all shards, and whether they are made or not.
Hash128 what_is_made(const Plan& plan);

/// Whether the three files stand as they were written from these sources.
bool manifest_stands(const Dataset& dataset, const ManifestSources& sources,
                     const PlacedFiles& placed);

/// Whether images.jsonl stands as this version of dsbuild wrote it, so that a line of it whose image
/// is as it was would be written again.
bool lines_hold(const Dataset& dataset, const ManifestSources& sources, const PlacedFiles& placed);

/// Enters the files just written.
void remember_manifest(Dataset& dataset, const ManifestSources& sources);

/// Reads the manifest only where it is behind, to say in what. `plan` but for its `manifest`.
ManifestState manifest_state(const Dataset& dataset, const Plan& plan, const PlacedFiles& placed);

}  // namespace ds

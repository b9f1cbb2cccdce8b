// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

#include <cstdint>
#include <vector>

namespace ds {

/// A thing that an image shows, and where.
struct ListedObject {
  const ObjectRecord* record = nullptr;  ///< of a thing beside the model; none: the model
  int label = 0;                         ///< of ExportInput::classes; -1 where it has no class
  MaskPixels mask;
};

/// The model, and behind it the others by id. Error(asset) where the image has others and no plane
/// object_id, whose file tells them apart.
std::vector<ListedObject> shown_objects(const ExportInput& input, const ExportImage& image);

/// The ids of the plane object_id, row by row from the top.
std::vector<std::uint32_t> read_ids(const ExportInput& input, const ExportImage& image);
/// Where the ids are that one.
MaskPixels mask_of_id(const std::vector<std::uint32_t>& ids, std::uint32_t id, int width,
                      int height);

}  // namespace ds

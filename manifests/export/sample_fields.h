// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

#include <nlohmann/json.hpp>

namespace ds {

/// Whether the recipe makes folds: samples then have a "fold", -1 where the image has none.
bool has_folds(const DatasetRecord& dataset);

/// What formats with a line of JSON for each image tell of it, the same fields of the same types for
/// every image: id, split, label (null without a class), class_path, model, material, environment,
/// view, seed, spp, width, height, camera_model, intrinsics (null where rays are parallel),
/// metres_per_pixel (null elsewhere), camera_to_world, relative_error (null where nobody knows it), draws
/// (by key, of a dataset that has some), and
/// where the dataset has masks bbox, [x, y, width, height] of what is seen in whole pixels, null where
/// nothing is.
nlohmann::json sample_fields(const ExportInput& input, const ExportImage& image);

/// "images/mug-1-3.png", and "depth/mug-1-3.exr" of a plane.
std::string place_of_kind(const ExportImage& image, const std::string& kind);

}  // namespace ds

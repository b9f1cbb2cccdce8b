// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace ds {

/// JSON Schemas (draft 2020-12) of a line of manifest/images.jsonl and of manifest/dataset.json, as this
/// dsbuild writes them: every field, its type, and what it is. Fields that a dataset may lack are not
/// required.
nlohmann::json image_schema();
nlohmann::json dataset_schema();

}  // namespace ds

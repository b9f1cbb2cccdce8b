// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/import/found_models.h"

#include <atomic>

namespace ds {

/// import_models with ImportRequest::update.
ImportResult update_import(const ImportRequest& request, const ImportProgress& progress,
                           const std::atomic<bool>& stop);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <atomic>
#include <cstdint>

namespace ds {

/// Puts back into a store what datasets name and it lacks, as far as the files that builds placed
/// in their folders still hold those bytes: no build would, since to it such a file is up to date.
/// How many objects. What a folder has not, a build makes again. Throws Error(io) where the disk
/// refuses, and Error(cancelled) where `stop` is set.
std::uint64_t restore_objects(Store& store, Database& database, const std::atomic<bool>& stop);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <filesystem>

namespace ds {

/// BuildRow::outcome of a build that the disk ended: full, read only or broken.
inline constexpr const char* k_disk_failed = "disk failed";

/// The database cannot take down that a build ended where the disk is full. A file of the dataset's
/// folder is to do it then: room for it is made when the build begins, and writing over what is
/// there takes none. Neither call throws: the build has its own error to tell.
void make_room_for_ending(const std::filesystem::path& folder);
void keep_ending(const std::filesystem::path& folder, const BuildRow& build);

/// The build as it ended: where the log has it as "running" though it is not, what `keep_ending`
/// kept of it, else "killed". As it is where it ended or runs.
BuildRow as_ended(const Dataset& dataset, BuildRow build);

}  // namespace ds

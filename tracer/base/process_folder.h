// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace ds {

/// Makes a fresh folder in `parent`, which is made where it is missing, for this process: it may
/// remove the folder, and once it has ended, however it ended, the next call for this parent by any
/// process does. Throws Error(io).
std::filesystem::path make_process_folder(const std::filesystem::path& parent);

/// Removes from `parent` what processes that have ended left there, and `parent` where nothing else is
/// in it. What cannot be removed stays.
void remove_ended_process_folders(const std::filesystem::path& parent);

}  // namespace ds

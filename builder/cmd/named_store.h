// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/disk.h"

#include <filesystem>
#include <string>

namespace ds {

/// Whether something of a store lies in the folder.
bool is_store(const std::filesystem::path& folder);

/// The folder of the store that a word of the command line names: its own, or a dataset that has
/// one. `verb`: "store gc". Throws Error(usage) with what was found in its place, and as
/// open_dataset.
std::filesystem::path named_store(const std::string& target, const std::string& verb, Disk& disk);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/dataset.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// What builds of a part (--no-files, or --shard with a database of its own) put into a store is of
/// no dataset there before a build of all images places it. So that no collection takes it
/// meanwhile, such a build leaves a note first, and one that placed everything takes it away:
///   STORE/parts/HASH   the recipe and its --set, as a command line has them; HASH is of the
///                      dataset's name and --set: other machines may see the recipe elsewhere
struct Parts {
  std::filesystem::path file;
  std::string recipe;
};

/// Throws Error(io).
void note_parts(const Dataset& dataset);
void forget_parts(const Dataset& dataset);
std::vector<Parts> find_parts(const Store& store);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/cmd/arguments.h"
#include "builder/upkeep/gather.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace ds {

/// "files" and "bytes".
nlohmann::json to_json(const Amount& amount);

/// "objects", "records", "there" and "unrecorded", each files and bytes; "faults" and "missing".
nlohmann::json to_json(const GatherResult& result);

/// `work`, and behind it, however it ends, what the store keeps on this machine's own disk
/// (--local) goes into the store: nothing where it keeps nothing there. What the store's disk
/// refuses stays, and `failed` tells so.
struct BroughtHome {
  std::optional<GatherResult> result;
  std::string failed;
};
BroughtHome work_and_bring_home(Store& store, Disk& disk, const std::function<void()>& work);

/// dsbuild store gather FROM TO. `from`: FROM's folder.
int run_gather(const Arguments& arguments, const std::filesystem::path& from, Disk& disk);

}  // namespace ds

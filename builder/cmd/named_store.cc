// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/named_store.h"

#include "builder/store/dataset.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& verb, const std::string& found) {
  fail(ErrorKind::usage, "{}: wanted a store, or a dataset that has one, found {}", verb, found);
}

}  // namespace

bool is_store(const fs::path& folder) {
  static constexpr std::array k_names{"objects", "records", "slurm", "dsbuild.sqlite"};
  return std::any_of(k_names.begin(), k_names.end(), [&](const char* name) {
    std::error_code error;
    return fs::exists(folder / name, error);
  });
}

fs::path named_store(const std::string& target, const std::string& verb, Disk& disk) {
  std::error_code error;
  if (!fs::exists(target, error)) refuse(verb, "nothing at " + target);
  const bool has_state = fs::exists(fs::path(target) / ".dsbuild", error);
  if (!has_state && is_store(target)) return target;
  if (!has_state && fs::is_directory(target, error) && !has_lost_state(target))
    refuse(verb, fmt::format("the folder {}, which is neither", target));
  const Dataset dataset =
      open_dataset({.target = target, .overrides = {}, .output_folder = {}, .store_folder = {}},
                   Access::records, disk);
  if (dataset.store == nullptr)
    refuse(verb, fmt::format("the recipe {}, of which nothing is built in {}", target,
                             dataset.folder.string()));
  return dataset.store->folder();
}

}  // namespace ds

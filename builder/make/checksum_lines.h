// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/verify.h"

#include <map>
#include <optional>
#include <set>
#include <string>

namespace ds {

/// The lines of a checksum file, "<32 hex digits>  <path>", its own path relative to the folder;
/// nothing, with a finding, where it is not there or damaged.
std::optional<std::map<std::string, Hash128>> read_checksums(VerifyResult& result,
                                                             const std::filesystem::path& folder,
                                                             const char* file);

/// Compares every file listed but `own` with its checksum, which `file` says.
void compare_with_checksums(VerifyResult& result, const std::filesystem::path& folder,
                            const std::map<std::string, Hash128>& sums,
                            const std::set<std::string>& own, const char* file);

/// Adds the files that are neither listed nor `own`, but for what lies in `.dsbuild`.
void find_extra(VerifyResult& result, const std::filesystem::path& folder,
                const std::map<std::string, Hash128>& listed, const std::set<std::string>& own);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/make/checksum_lines.h"

#include "manifests/whole_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"

#include <algorithm>
#include <system_error>
#include <vector>

namespace ds {

namespace fs = std::filesystem;

namespace {

/// A gallery has checksums of its own; or what one that was killed left beside its place.
bool is_of_gallery(const fs::path& folder) {
  return folder.filename() == k_gallery_folder.work || is_whole_folder(folder, k_gallery_folder);
}

}  // namespace

std::optional<std::map<std::string, Hash128>> read_checksums(VerifyResult& result,
                                                             const fs::path& folder,
                                                             const char* file) {
  std::error_code error;
  if (!fs::is_regular_file(folder / file, error)) {
    result.findings.push_back({Finding::Kind::missing, file, "the file is missing", ""});
    return std::nullopt;
  }
  try {
    return read_checksum_file(folder / file);
  } catch (const Error& damaged) {
    result.findings.push_back({Finding::Kind::manifest, file, damaged.what(), ""});
    return std::nullopt;
  }
}

void compare_with_checksums(VerifyResult& result, const fs::path& folder,
                            const std::map<std::string, Hash128>& sums,
                            const std::set<std::string>& own, const char* file) {
  for (const auto& [path, hash] : sums) {
    if (own.contains(path)) continue;
    ++result.files;
    std::error_code error;
    if (!fs::is_regular_file(folder / path, error))
      result.findings.push_back({Finding::Kind::missing, path, "the file is missing", ""});
    else if (content_hash(folder / path) != hash)
      result.findings.push_back({Finding::Kind::changed, path,
                                 fmt::format("it has another checksum than {} says", file), ""});
  }
}

void find_extra(VerifyResult& result, const fs::path& folder,
                const std::map<std::string, Hash128>& listed, const std::set<std::string>& own) {
  std::vector<std::string> extra;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string path = entry->path().lexically_relative(folder).generic_string();
    std::error_code vanished;
    const bool is_folder = entry->is_directory(vanished);
    if (path == ".dsbuild" || (is_folder && is_of_gallery(entry->path()))) {
      entry.disable_recursion_pending();
      continue;
    }
    if (!is_folder && !own.contains(path) && !listed.contains(path)) extra.push_back(path);
  }
  if (error)
    result.findings.push_back(
        {Finding::Kind::extra, ".", "its folders cannot be listed: " + error.message(), ""});
  std::sort(extra.begin(), extra.end());
  for (const std::string& path : extra)
    result.findings.push_back({Finding::Kind::extra, path, "nothing lists it", ""});
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/store/parts.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash.h"
#include "tracer/base/shell_quoted.h"

#include <algorithm>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const Store& store) {
  return store.folder() / "parts";
}

fs::path file_of(const Dataset& dataset) {
  std::string text = dataset.row.name;
  for (const std::string& assignment : dataset.row.overrides)
    text += '\n' + assignment;
  return folder_of(*dataset.store) / hash_text(text).hex();
}

}  // namespace

void note_parts(const Dataset& dataset) {
  const fs::path file = file_of(dataset);
  std::error_code error;
  if (fs::exists(file, error)) return;
  std::string text = shell_quoted(fs::absolute(dataset.recipe.file).lexically_normal().string());
  for (const std::string& assignment : dataset.row.overrides)
    text += " --set " + shell_quoted(assignment);
  write_file_atomic(file, text);
}

void forget_parts(const Dataset& dataset) {
  std::error_code error;
  fs::remove(file_of(dataset), error);
  if (error) fail_system(file_of(dataset), "remove", error.value());
}

std::vector<Parts> find_parts(const Store& store) {
  std::vector<Parts> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(store), error), end; !error && entry != end;
       entry.increment(error))
    if (Hash128::from_hex(entry->path().filename().string()))
      found.push_back({entry->path(), read_text_file(entry->path())});
  if (error && error != std::errc::no_such_file_or_directory)
    fail_system(folder_of(store), "list", error.value());
  std::sort(found.begin(), found.end(),
            [](const Parts& a, const Parts& b) { return a.file < b.file; });
  return found;
}

}  // namespace ds

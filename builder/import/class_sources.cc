// SPDX-License-Identifier: Apache-2.0
#include "builder/import/class_sources.h"

#include "builder/recipe/class_files.h"
#include "tracer/base/file_names.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <map>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::size_t class_count(const ClassSource& source) {
  std::size_t count = 0;
  for (const fs::path& file : source.files) {
    try {
      count += static_cast<std::size_t>(read_classification(file).leaf_count());
    } catch (const Error&) {  // told where the recipe is read
    }
  }
  return count;
}

}  // namespace

std::vector<ClassSource> find_class_sources(const fs::path& folder) {
  std::map<std::string, ClassSource> found;
  std::error_code error;
  const auto options = fs::directory_options::follow_directory_symlink |
                       fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, error), end; !error && at != end;
       at.increment(error)) {
    constexpr int k_deepest = 32;  // links may lead round
    if (at.depth() > k_deepest) at.disable_recursion_pending();
    std::error_code ignored;
    if (!has_ending(at->path(), ".cla") || !fs::is_regular_file(at->path(), ignored)) continue;
    const std::string name = hierarchy_name(at->path());
    found[name].name = name;
    found[name].files.push_back(at->path());
  }
  std::vector<ClassSource> sources;
  for (auto& [name, source] : found) {
    std::sort(source.files.begin(), source.files.end());
    for (const fs::path& file : source.files) {
      fs::path& split = split_of_class_file(file) == "test" ? source.test : source.train;
      if (!split_of_class_file(file).empty() && split.empty()) split = file;
    }
    sources.push_back(std::move(source));
  }
  const auto main =
      std::max_element(sources.begin(), sources.end(), [](const auto& a, const auto& b) {
        if ((a.name == "base") != (b.name == "base")) return b.name == "base";
        return class_count(a) < class_count(b);
      });
  if (main != sources.end()) std::rotate(sources.begin(), main, main + 1);
  return sources;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/import/import.h"
#include "builder/import/init_text.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/streams.h"
#include "tracer/scene/mesh_formats.h"

#include <filesystem>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

bool has_models(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && has_mesh_ending(entry->path())) return true;
  }
  return false;
}

/// A name that a recipe may give its dataset.
std::string name_of(const fs::path& folder) {
  std::string name;
  for (const char c : folder.filename().string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || (c == '.' && !name.empty());
    name += plain ? c : '-';
  }
  return name.empty() ? "dataset" : name;
}

}  // namespace

int run_init(const Arguments& arguments) {
  std::error_code error;
  fs::path folder = fs::absolute(arguments.import_from).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error))
    fail(ErrorKind::usage, "init: wanted a folder of models, found {} at {}",
         fs::exists(folder, error) ? "a file" : "nothing", folder.string());
  if (!has_models(folder))
    fail(ErrorKind::usage,
         "{}: wanted models ({}) in it, found none; dsbuild import takes folders within folders",
         folder.string(), mesh_endings_text());
  const std::string name = name_of(folder);
  const fs::path file =
      arguments.init_file.empty() ? fs::path(name + ".toml") : fs::path(arguments.init_file);
  if (fs::exists(file, error))
    fail(ErrorKind::usage, "-o {}: is there already; init writes over nothing", file.string());
  const fs::path from = fs::absolute(file).lexically_normal().parent_path();
  const fs::path near = folder.lexically_relative(from);
  const bool is_beside = !near.empty() && *near.begin() != "..";
  write_file_atomic(file, commented_recipe(name, is_beside ? near : folder, shipped_assets()));
  if (arguments.json)
    print_json({{"recipe", file.string()}, {"name", name}});
  else
    say(Stream::report, "{}: edit it, then dsbuild build {}\n", file.string(), file.string());
  return 0;
}

}  // namespace ds

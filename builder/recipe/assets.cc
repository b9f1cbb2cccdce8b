// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/assets.h"

#include "builder/recipe/recipe.h"
#include "manifests/json_text.h"
#include "manifests/licences.h"
#include "tracer/base/file_names.h"
#include "tracer/base/log.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <sys/stat.h>
#include <system_error>
#include <utility>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// What tells models, materials and environments apart.
struct AssetKind {
  std::string_view section;
  std::string_view wanted;            ///< of an element of `files`
  std::string (*wanted_in_folder)();  ///< of a folder's content
  bool (*is_one)(const fs::path&);    ///< whether a path named in `files` can be one
  bool (*belongs)(const fs::path&);   ///< whether an entry of `dir` is one
  std::string (*name)(const fs::path&);
  bool of_meshes = false;
};

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool is_model(const fs::path& path) {
  return has_mesh_ending(path) && is_file(path);
}
bool is_material(const fs::path& path) {
  return has_ending(path, ".mat") && is_file(path);
}
bool is_environment(const fs::path& path) {
  return is_file(path / "environment.scn");
}
/// One whose scene is no file.
bool is_odd_environment(const fs::path& path) {
  std::error_code error;
  return !is_environment(path) && fs::exists(path / "environment.scn", error);
}
std::string file_name(const fs::path& path) {
  return path.filename().string();
}

constexpr AssetKind k_models{"models", "a file", [] { return mesh_endings_text() + " file"; },
                             is_file,  is_model, file_name,
                             true};
constexpr AssetKind k_distractors{
    "distractors", "a file", [] { return mesh_endings_text() + " file"; }, is_file, is_model,
    file_name,     true};
constexpr AssetKind k_materials{"materials", "a file",    [] { return std::string(".mat file"); },
                                is_file,     is_material, material_name};
constexpr AssetKind k_environments{
    "environments",
    "a folder that holds an environment.scn",
    [] { return std::string("folder that holds an environment.scn"); },
    is_environment,
    is_environment,
    environment_name};

bool fits_manifest(const std::string& name) {
  const bool odd = std::any_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\';
  });
  try {
    canonical_json(name);
  } catch (const Error&) {
    return false;
  }
  return !odd;
}

/// What a folder holds, hidden entries left out but for their number.
struct Listing {
  std::vector<fs::path> found;                ///< what belongs
  std::map<std::string, std::size_t> others;  ///< files that do not, by ending
  std::vector<std::string> hidden;            ///< names of hidden entries that else would belong
  std::size_t dead_links = 0;
  std::size_t specials = 0;        ///< pipes, sockets, devices: of whatever ending
  std::size_t unread_folders = 0;  ///< that hold what would belong
};

/// Texts that may lie beside what belongs without being meant for anything.
bool is_remark(const fs::path& path) {
  std::string name = file_name(path);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return is_licence_folder_name(file_name(path.parent_path())) || is_licence_name(name) ||
         is_source_name(name) || name.starts_with("NOTICE") || name.starts_with("README") ||
         name.ends_with(".CLA");
}

/// Looks into a folder, in the order of names, and with `recursive` into those in it, links
/// followed: each once, by whatever way it is reached, so that links may lead round.
class FolderWalk {
 public:
  FolderWalk(const AssetKind& kind, bool recursive) : kind_(kind), recursive_(recursive) {}

  Listing list(const fs::path& folder, std::error_code& error) {
    first_visit(folder);
    walk(folder, error);
    return std::move(listing_);
  }

 private:
  static bool is_hidden(const fs::path& path) { return file_name(path).starts_with('.'); }

  static std::vector<fs::path> entries(const fs::path& folder, std::error_code& error) {
    std::vector<fs::path> paths;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
      paths.push_back(at->path());
    std::sort(paths.begin(), paths.end());
    return paths;
  }

  bool first_visit(const fs::path& folder) {
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0) return false;
    return seen_.emplace(status.st_dev, status.st_ino).second;
  }

  void walk(const fs::path& folder, std::error_code& error) {
    for (const fs::path& path : entries(folder, error)) {
      std::error_code ignored;
      if (is_hidden(path)) {
        if (kind_.belongs(path)) listing_.hidden.push_back(file_name(path));
        continue;
      }
      if (kind_.belongs(path))
        listing_.found.push_back(path);
      else if (fs::is_symlink(path, ignored) && !fs::exists(path, ignored))
        ++listing_.dead_links;
      else if (fs::is_directory(path, ignored))
        enter(path, error);
      else if (!fs::is_regular_file(path, ignored))
        ++listing_.specials;
      else if (!is_remark(path))
        ++listing_.others[path.extension().string()];
      if (error) return;
    }
  }

  void enter(const fs::path& folder, std::error_code& error) {
    if (!first_visit(folder)) return;
    if (kind_.section == "environments" && is_odd_environment(folder)) ++listing_.specials;
    if (recursive_)
      walk(folder, error);
    else if (kind_.of_meshes && holds_one(folder))
      ++listing_.unread_folders;
  }

  /// Up to the first that belongs.
  bool holds_one(const fs::path& folder) {
    std::error_code ignored;
    for (const fs::path& path : entries(folder, ignored)) {
      if (is_hidden(path)) continue;
      if (kind_.belongs(path)) return true;
      if (fs::is_directory(path, ignored) && first_visit(path) && holds_one(path)) return true;
    }
    return false;
  }

  const AssetKind& kind_;
  bool recursive_;
  Listing listing_;
  std::set<std::pair<dev_t, ino_t>> seen_;
};

/// Of what models' own materials are in.
bool is_of_materials(const std::string& ending) {
  constexpr std::array<std::string_view, 10> k_endings{".mtl", ".png", ".jpg",  ".jpeg", ".tga",
                                                       ".bmp", ".tif", ".tiff", ".webp", ".exr"};
  return std::any_of(k_endings.begin(), k_endings.end(),
                     [&](std::string_view known) { return has_ending("file" + ending, known); });
}

/// What of a folder is not used, in words; empty: nothing worth a word.
std::string unused_text(const Listing& listing, const AssetKind& kind) {
  std::vector<std::string> parts;
  if (!listing.others.empty() && kind.of_meshes) {
    std::size_t count = 0;
    std::vector<std::string> endings;
    for (const auto& [ending, files] : listing.others) {
      count += files;
      endings.push_back(fmt::format("{} {}", files, ending.empty() ? "without" : ending));
    }
    parts.push_back(fmt::format("{} file{} of other endings ({}); {} are read", count,
                                count == 1 ? "" : "s", fmt::join(endings, ", "),
                                mesh_endings_text(" and ")));
  }
  if (const std::size_t count = listing.hidden.size(); count > 0)
    parts.push_back(fmt::format("{} whose name{} with a dot, which hides {} ({}{})", count,
                                count == 1 ? " begins" : "s begin", count == 1 ? "it" : "them",
                                listing.hidden.front(), count == 1 ? "" : ", ..."));
  if (listing.specials > 0)
    parts.push_back(fmt::format("{} that {} (a pipe, socket or device)", listing.specials,
                                listing.specials == 1 ? "is no file" : "are no files"));
  if (listing.dead_links > 0)
    parts.push_back(fmt::format("{} link{} nowhere", listing.dead_links,
                                listing.dead_links == 1 ? " that leads" : "s that lead"));
  if (listing.unread_folders > 0)
    parts.push_back(fmt::format("{} folder{} models; models.recursive = true reads {}",
                                listing.unread_folders,
                                listing.unread_folders == 1 ? " that holds" : "s that hold",
                                listing.unread_folders == 1 ? "it" : "them"));
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// A path as it is written, less what leads up or to the root: below whatever folder it is put in, it
/// stays there.
std::string path_below(const std::string& written) {
  fs::path below;
  for (const fs::path& part : fs::path(written).lexically_normal().relative_path())
    if (part != "..") below /= part;
  return below.generic_string();
}

std::vector<fs::path> paths_of(const std::map<std::string, ModelFile>& by_name) {
  std::vector<fs::path> paths;
  for (const auto& [name, asset] : by_name)
    paths.push_back(asset.file);
  return paths;
}

class Finder {
 public:
  Finder(const AssetKind& kind, Settings& settings)
      : kind_(kind),
        settings_(settings),
        dir_key_(std::string(kind.section) + ".dir"),
        files_key_(std::string(kind.section) + ".files") {}

  /// By name, which sorts them.
  std::map<std::string, ModelFile> find() {
    choose_key();
    if (const RecipeValue* files = settings_.find(files_key_)) {
      for (const RecipeValue& file : *files->array())
        add_named(file);
    } else if (const RecipeValue* dir = settings_.find(dir_key_)) {
      add_folder(*dir);
    }
    return std::move(found_);
  }
  /// Of a kind that has no `files`.
  std::map<std::string, ModelFile> find_in_folder() {
    add_folder(*settings_.find(dir_key_));
    return std::move(found_);
  }

 private:
  /// One of the two keys stays; the one that --set gives replaces the recipe's other.
  void choose_key() {
    if (settings_.given(dir_key_) && settings_.given(files_key_)) {
      if (settings_.given_by_set(files_key_) && !settings_.given_by_set(dir_key_)) {
        settings_.unset(dir_key_);
      } else if (settings_.given_by_set(dir_key_) && !settings_.given_by_set(files_key_)) {
        settings_.unset(files_key_);
      } else if (const RecipeValue* files = settings_.find(files_key_)) {
        settings_.complain(*files, files_key_, "must not be given together with " + dir_key_);
      }
    } else if (!settings_.given(dir_key_) && !settings_.given(files_key_)) {
      if (settings_.misspelt(files_key_)) return;
      settings_.complain(
          dir_key_, fmt::format("or {} must be given, for example with --set {}=FOLDER", files_key_,
                                dir_key_));
    }
  }

  void add_named(const RecipeValue& file) {
    const fs::path path = settings_.resolve(file);
    if (kind_.is_one(path)) {
      add(file, files_key_, path, path_below(*file.text()));
    } else {
      settings_.complain(file, files_key_,
                         fmt::format("must name {}, found none at {}{}", kind_.wanted,
                                     path.string(), similar_name(path)));
    }
  }

  void add_folder(const RecipeValue& dir) {
    const fs::path folder = settings_.resolve(dir);
    std::error_code error;
    const bool recursive = kind_.of_meshes && settings_.boolean("models.recursive");
    Listing listing = FolderWalk(kind_, recursive).list(folder, error);
    if (kind_.of_meshes && settings_.text("materials.assign") == k_own_materials)
      std::erase_if(listing.others, [](const auto& files) { return is_of_materials(files.first); });
    const std::string unused = unused_text(listing, kind_);
    if (error) {
      settings_.complain(dir, dir_key_,
                         fmt::format("must be a folder, found {}: {}{}", folder.string(),
                                     error.message(), similar_name(folder)));
    } else if (listing.found.empty()) {
      settings_.complain(
          dir, dir_key_,
          fmt::format("must hold a {}, found none in {}{}{}", kind_.wanted_in_folder(),
                      folder.string(), unused.empty() ? "" : ", but ", unused));
    } else if (!unused.empty()) {
      warn(fmt::format("{}: not used of {}: {}", dir_key_, folder.string(), unused));
    }
    for (const fs::path& path : listing.found)
      add(dir, dir_key_, path, path.lexically_relative(folder).generic_string());
  }

  bool named_by_path() const { return kind_.of_meshes && settings_.text("models.names") == "path"; }

  void add(const RecipeValue& giver, const std::string& key, const fs::path& path,
           const std::string& below) {
    const std::string name = named_by_path() ? below : kind_.name(path);
    if (!fits_manifest(name)) {
      settings_.complain(
          giver, key,
          fmt::format(
              "must give names of UTF-8 without control characters and backslashes, got {:?}",
              path.string()));
      return;
    }
    const auto [other, is_new] = found_.emplace(name, ModelFile{name, path, below});
    if (!is_new) {
      settings_.complain(giver, key,
                         fmt::format("must give each name once, got {} at {} and {}{}", name,
                                     std::min(other->second.file, path).string(),
                                     std::max(other->second.file, path).string(),
                                     kind_.of_meshes && !named_by_path()
                                         ? "; models.names = \"path\" tells them apart"
                                         : ""));
    }
  }

  const AssetKind& kind_;
  Settings& settings_;
  std::string dir_key_, files_key_;
  std::map<std::string, ModelFile> found_;
};

}  // namespace

std::vector<ModelFile> find_models(Settings& settings) {
  std::vector<ModelFile> models;
  for (const auto& [name, model] : Finder(k_models, settings).find())
    models.push_back(model);
  return models;
}
std::vector<ModelFile> find_distractors(Settings& settings) {
  std::vector<ModelFile> models;
  for (const auto& [name, model] : Finder(k_distractors, settings).find_in_folder())
    models.push_back(model);
  return models;
}
std::vector<fs::path> find_materials(Settings& settings) {
  const bool own = settings.text("materials.assign") == k_own_materials;
  if (own && !settings.given("materials.dir") && !settings.given("materials.files")) return {};
  return paths_of(Finder(k_materials, settings).find());
}
std::vector<fs::path> find_environments(Settings& settings) {
  return paths_of(Finder(k_environments, settings).find());
}

}  // namespace ds

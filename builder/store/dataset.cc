// SPDX-License-Identifier: Apache-2.0
#include "builder/store/dataset.h"

#include "builder/store/folder_lock.h"
#include "builder/store/input_folders.h"
#include "builder/store/slurm_mark.h"
#include "builder/store/store_database.h"
#include "builder/store/working_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/log.h"

#include <algorithm>
#include <random>
#include <set>
#include <sstream>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_state_folder = ".dsbuild";
constexpr const char* k_pointer_file = "dataset";
constexpr const char* k_pointer_header = "dsbuild dataset 2";
constexpr const char* k_older_header = "dsbuild dataset 1";

/// `.dsbuild/dataset`, a line each:
///   "dsbuild dataset 2"
///   the dataset's id
///   the store's folder, "." or absolute
///   the dataset's folder when it was last built, absolute
///   the recipe that the folder belongs to, absolute
/// Version 1 had the first three only.
struct Pointer {
  std::string id;
  fs::path store;           ///< absolute
  fs::path folder, recipe;  ///< empty in version 1

  bool operator==(const Pointer&) const = default;
};

fs::path pointer_path(const fs::path& folder) {
  return folder / k_state_folder / k_pointer_file;
}

fs::path normal(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();  // "out/" is "out"
}

/// Nothing where there is none or it is damaged, which a warning says unless `silent`.
std::optional<Pointer> read_pointer(const fs::path& folder, bool silent = false) {
  const fs::path file = pointer_path(folder);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  std::istringstream text(read_text_file(file));
  std::string header, id, store, built, recipe;
  for (std::string* line : {&header, &id, &store, &built, &recipe})
    std::getline(text, *line);
  const bool whole = header == k_pointer_header && !built.empty() && !recipe.empty();
  if (!(whole || header == k_older_header) || !Hash128::from_hex(id) || store.empty()) {
    if (!silent) warn(fmt::format("{}: damaged; the dataset is entered anew", file.string()));
    return std::nullopt;
  }
  Pointer pointer{id, normal(folder / k_state_folder / store), {}, {}};
  if (whole) {
    pointer.folder = built;
    pointer.recipe = recipe;
  }
  return pointer;
}

void write_pointer(const fs::path& folder, const Pointer& pointer, Disk& disk) {
  const fs::path state = folder / k_state_folder;
  // A store inside the dataset's folder moves with it; any other stays where it is.
  const bool own = pointer.store == state;
  const std::string text = fmt::format("{}\n{}\n{}\n{}\n{}\n", k_pointer_header, pointer.id,
                                       own ? "." : pointer.store.string(), pointer.folder.string(),
                                       pointer.recipe.string());
  disk.write(pointer_path(folder), bytes_of(text));
}

std::string new_id() {
  std::random_device device;
  const auto word = [&] { return (std::uint64_t{device()} << 32) | device(); };
  return Hash128{word(), word()}.hex();
}

/// The place as it is under all links, but for a link of its last name: two recipes that link to one
/// file read their paths from two folders.
fs::path place_of(const fs::path& file) {
  std::error_code error;
  const fs::path whole = normal(file);
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), error);
  return (error ? whole.parent_path() : folder) / whole.filename();
}

bool same_place(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a == b ||
         (a.filename() == b.filename() && fs::equivalent(a.parent_path(), b.parent_path(), error));
}

/// Whether both are files that can be read, and not of the same bytes.
bool are_two_files(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (!fs::is_regular_file(a, error) || !fs::is_regular_file(b, error)) return false;
  try {
    return content_hash(a) != content_hash(b);
  } catch (const Error&) {
    return false;
  }
}

/// Where a path of when the folder was built leads now: to the same place seen from the folder,
/// where folder and path were moved or copied together, else where it led. A file that lies there
/// by chance while the one it led to is where it was, and of other bytes, was not moved.
fs::path moved(const fs::path& path, const Pointer& pointer, const fs::path& folder) {
  if (pointer.folder.empty()) return path;
  const fs::path beside = (folder / path.lexically_relative(pointer.folder)).lexically_normal();
  std::error_code error;
  return fs::exists(beside, error) && !are_two_files(path, beside) ? beside : path;
}

/// Whether the folder with this pointer belongs to the recipe, as far as the pointer tells.
bool belongs_to(const Pointer& pointer, const fs::path& folder, const fs::path& recipe) {
  const fs::path place = place_of(recipe);
  return same_place(pointer.recipe, place) ||
         same_place(moved(pointer.recipe, pointer, place_of(folder)), place);
}

/// out/<name> in the working folder; where nothing of the recipe lies there, the nearest such folder
/// above it or above the recipe that belongs to it: where a command is typed is not to decide which
/// dataset it is about.
fs::path default_folder(const Recipe& recipe) {
  const fs::path name = fs::path("out") / recipe.name;
  fs::path here = normal(name);
  for (const fs::path& start : {fs::current_path(), recipe.file.parent_path()})
    for (fs::path above = start;; above = above.parent_path()) {
      fs::path folder = normal(above / name);
      const std::optional<Pointer> pointer = read_pointer(folder, true);
      if (pointer && !pointer->recipe.empty() && belongs_to(*pointer, folder, recipe.file))
        return folder;
      if (!above.has_relative_path()) break;
    }
  return here;
}

/// The folders beside the dataset's, which is not there yet, that belong to its recipe; in order.
std::vector<fs::path> folders_beside(const Dataset& dataset) {
  std::set<fs::path> folders;
  for (const fs::path& above :
       {dataset.folder.parent_path(), dataset.recipe.file.parent_path() / "out"}) {
    std::error_code error;
    for (fs::directory_iterator at(above, error), end; !error && at != end; at.increment(error)) {
      const std::optional<Pointer> pointer = read_pointer(at->path(), true);
      if (pointer && !pointer->recipe.empty() &&
          belongs_to(*pointer, at->path(), dataset.recipe.file))
        folders.insert(normal(at->path()));
    }
  }
  return {folders.begin(), folders.end()};
}

fs::path folder_of(const DatasetRequest& request, const Recipe& recipe) {
  return request.output_folder.empty() ? default_folder(recipe) : normal(request.output_folder);
}

/// Beside a database of the machine's own, since the folder's file system may know no locks.
fs::path lock_folder_of(const DatasetRequest& request, const fs::path& folder) {
  return request.database_folder.empty() ? folder / k_state_folder
                                         : normal(request.database_folder);
}

/// Throws where the folder belongs to another recipe.
void check_owner(const DatasetRequest& request, const fs::path& folder, const Recipe& recipe,
                 const std::optional<Pointer>& pointer, Database* database) {
  if (!pointer || request.adopt) return;
  fs::path owner = pointer->recipe;
  if (owner.empty()) {
    // Of an older dsbuild. One whose recipe is gone may have been moved with it.
    const auto row = database != nullptr ? database->find_dataset(pointer->id) : std::nullopt;
    std::error_code error;
    if (!row || !fs::exists(row->recipe, error)) return;
    owner = place_of(row->recipe);
    if (same_place(owner, place_of(recipe.file))) return;
  } else if (belongs_to(*pointer, folder, recipe.file)) {
    return;
  }
  fail(ErrorKind::usage,
       "{}: the folder belongs to the recipe {}, found {}; give this one a dataset.name of its own "
       "or another folder (-o), or hand the folder over with build --adopt (plan --adopt says what "
       "that would make)",
       folder.string(), owner.string(), recipe.file.string());
}

/// Throws where the folder holds what a build would write over and no build is known to have put
/// there: somebody's own files, or a dataset handed on without its `.dsbuild`.
void check_unclaimed(const DatasetRequest& request, const fs::path& folder) {
  std::error_code error;
  if (request.adopt) return;
  // In this order: a build that begins meanwhile writes the pointer before it makes these.
  for (const char* name : {"images", "manifest"})
    if (fs::exists(folder / name, error) && !fs::exists(pointer_path(folder), error))
      fail(ErrorKind::usage,
           "{}: is there already, and {} does not say that dsbuild made it; take another folder "
           "(-o), or hand this one over with build --adopt",
           (folder / name).string(), pointer_path(folder).string());
}

void open_store(Dataset& dataset, const fs::path& folder, const DatasetRequest& request,
                Access access, Disk& disk) {
  dataset.store = std::make_unique<Store>(
      folder, disk, request.local_folder.empty() ? fs::path() : normal(request.local_folder));
  const fs::path own =
      request.database_folder.empty()
          ? database_beside(folder, dataset.folder / k_state_folder, access == Access::build)
          : normal(request.database_folder);
  if (access != Access::build)
    dataset.store->leave_damage();
  else if (own.empty())
    refuse_read_only(folder, "a build keeps there what it makes");
  if (!own.empty()) {
    dataset.claims = std::make_unique<Claims>(own / "lock");
    dataset.database = open_local_database(*dataset.store, *dataset.claims, own);
    return;
  }
  // What fills the store from several machines keeps no database in it.
  const std::optional<SlurmMark> mark = find_slurm_mark(*dataset.store);
  if (access != Access::build && (mark || is_read_only(folder))) {
    dataset.database = open_database_copy(*dataset.store, mark.has_value());
    return;
  }
  if (mark && request.check_filled) request.check_filled(*mark);
  dataset.claims = std::make_unique<Claims>(folder / "lock");
  dataset.database = open_database(*dataset.store, *dataset.claims);
}

constexpr const char* k_datasets = "datasets";

/// A store that many datasets share is to know where they lie.
void note_folder(const Store& store, const Pointer& pointer, Disk& disk) {
  if (store.folder() == pointer.folder / k_state_folder || is_read_only(store.folder())) return;
  if (folder_of_dataset(store, pointer.id) == pointer.folder) return;
  disk.write(store.folder() / k_datasets / pointer.id, bytes_of(pointer.folder.string() + "\n"));
}

/// Writes whose the folder is. Builds that start at once in a new folder enter one dataset, not one
/// each, and one recipe.
Pointer enter_folder(const Dataset& dataset, const DatasetRequest& request, Pointer pointer,
                     Disk& disk) {
  FolderLock lock(dataset.lock_folder);
  const FolderLock::Gate gate(lock);
  const std::optional<Pointer> known = read_pointer(dataset.folder, true);
  check_owner(request, dataset.folder, dataset.recipe, known, dataset.database.get());
  if (known) pointer.id = known->id;
  pointer.folder = place_of(dataset.folder);
  pointer.recipe = place_of(dataset.recipe.file);
  // A copy that shares its store with what it was copied from is a dataset of its own.
  if (known && !known->folder.empty() && known->folder != pointer.folder)
    if (const auto other = read_pointer(known->folder, true);
        other && other->id == known->id && other->store == pointer.store)
      pointer.id = new_id();
  if (known != pointer) write_pointer(dataset.folder, pointer, disk);
  if (!request.in_passing) note_folder(*dataset.store, pointer, disk);
  return pointer;
}

/// Throws where the recipe of a folder is no longer there.
void check_recipe_is_there(const fs::path& folder, const fs::path& recipe) {
  std::error_code error;
  if (fs::exists(recipe, error)) return;
  fail(ErrorKind::recipe,
       "{0}: was built from the recipe {1}, which is no longer there; put it back, or hand the "
       "folder "
       "over to it where it is now: dsbuild build RECIPE -o {0} --adopt (verify, log, check, "
       "gallery and export need no recipe)",
       folder.string(), recipe.string());
}

/// For a folder that no build wrote: the recipe in it, or beside it and of its name, that may have
/// been meant.
std::string recipe_meant(const fs::path& folder) {
  std::error_code error;
  const fs::path beside = folder.string() + ".toml";
  if (fs::is_regular_file(beside, error)) return fmt::format(", did you mean {}?", beside.string());
  // As dsbuild import names it, whatever else lies there.
  const fs::path within = folder / "recipe.toml";
  if (fs::is_regular_file(within, error)) return fmt::format(", did you mean {}?", within.string());
  std::vector<fs::path> recipes;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error))
    if (entry->path().extension() == ".toml") recipes.push_back(entry->path());
  return recipes.size() == 1 ? fmt::format(", did you mean {}?", recipes.front().string()) : "";
}

/// Throws where something is said that only a recipe in the folder's place could heed.
void check_needs_no_recipe(const DatasetRequest& request) {
  if (!request.overrides.empty())
    fail(ErrorKind::usage,
         "--set needs a recipe, found the folder {}, which keeps the settings it was built with",
         request.target.string());
  if (!request.output_folder.empty())
    fail(ErrorKind::usage, "-o needs a recipe, found the folder {}", request.target.string());
}

Dataset open_folder(const DatasetRequest& request, Access access, Disk& disk) {
  check_needs_no_recipe(request);
  Dataset dataset;
  dataset.folder = normal(request.target);
  dataset.lock_folder = lock_folder_of(request, dataset.folder);
  const std::optional<Pointer> pointer = read_pointer(dataset.folder);
  if (!pointer && has_lost_state(dataset.folder))
    fail(ErrorKind::usage,
         "{0}: its .dsbuild is missing, which says what made it: build the recipe with -o {0} "
         "--adopt "
         "(verify, check and export need no .dsbuild)",
         request.target.string());
  if (!pointer)
    fail(ErrorKind::usage, "{}: wanted a recipe or a folder that dsbuild built{}",
         request.target.string(), recipe_meant(dataset.folder));
  std::error_code error;
  if (!fs::is_directory(pointer->store, error))
    fail(ErrorKind::io,
         "{}: its store {} is not there; put it back, or build the recipe with -o and --store",
         dataset.folder.string(), pointer->store.string());
  open_store(dataset, pointer->store, request, access, disk);
  const std::optional<DatasetRow> row = dataset.database->find_dataset(pointer->id);
  if (!row)
    fail(ErrorKind::io, "{}: the store {} knows nothing of it; build its recipe again",
         dataset.folder.string(), pointer->store.string());
  dataset.row = *row;
  if (access == Access::records) return dataset;
  const fs::path place = place_of(dataset.folder);
  dataset.row.recipe = moved(row->recipe, *pointer, place);
  check_recipe_is_there(dataset.folder, dataset.row.recipe);
  std::optional<WorkingFolder> working_folder;
  if (!row->overrides.empty()) {
    if (dataset.row.recipe != row->recipe)
      dataset.row.working_folder = moved(row->working_folder, *pointer, place);
    working_folder.emplace(dataset.row.working_folder);
  }
  dataset.recipe = read_recipe(dataset.row.recipe, row->overrides);
  if (access == Access::build) dataset.row.id = enter_folder(dataset, request, *pointer, disk).id;
  return dataset;
}

bool names_dataset(const std::vector<std::string>& overrides) {
  return std::any_of(overrides.begin(), overrides.end(), [](const std::string& assignment) {
    return assignment.starts_with("dataset.name");
  });
}

/// Says where the recipe's dataset lies that was built before it was given another name: the folder
/// named after the new one is empty, and everything would be made again. Settings of a command line
/// that bring their own name are a dataset beside it.
void tell_of_older_name(const DatasetRequest& request, const Dataset& dataset, Disk& disk) {
  if (names_dataset(request.overrides)) return;
  for (const fs::path& folder : folders_beside(dataset)) {
    DatasetRow row;
    try {
      row =
          open_dataset({.target = folder, .overrides = {}, .output_folder = {}, .store_folder = {}},
                       Access::records, disk)
              .row;
    } catch (const DamagedDatabase&) {
      continue;  // it is mended by who works in it
    } catch (const Error&) {
      continue;
    }
    if (row.name == dataset.recipe.name || names_dataset(row.overrides)) continue;
    warn(fmt::format(
        "{0}: this recipe was built there as the dataset {1}; as {2} it has a folder of its own, "
        "{3}, "
        "where nothing is yet: to go on with what is made, give -o {0}, or move the folder there",
        folder.string(), row.name, dataset.recipe.name, dataset.folder.string()));
  }
}

Dataset open_recipe(const DatasetRequest& request, Access access, Disk& disk) {
  Dataset dataset;
  dataset.recipe = read_recipe(request.target, request.overrides);
  dataset.folder = folder_of(request, dataset.recipe);
  dataset.lock_folder = lock_folder_of(request, dataset.folder);
  if (access != Access::inputs) {
    check_no_input_folder(dataset.folder, request.output_folder.empty() ? "dataset.name" : "-o",
                          dataset.recipe);
    if (!request.store_folder.empty())
      check_no_input_folder(normal(request.store_folder), "--store", dataset.recipe);
  }
  const std::optional<Pointer> known = read_pointer(dataset.folder);
  if (!known && access != Access::inputs && request.output_folder.empty())
    tell_of_older_name(request, dataset, disk);
  Pointer pointer = known.value_or(Pointer{new_id(), dataset.folder / k_state_folder, {}, {}});
  if (!request.store_folder.empty()) pointer.store = normal(request.store_folder);
  std::error_code error;
  const bool has_store = fs::is_directory(pointer.store, error);
  if (access != Access::inputs && known && !known->recipe.empty())
    check_owner(request, dataset.folder, dataset.recipe, known, nullptr);
  if (access == Access::build) check_unclaimed(request, dataset.folder);
  if (access != Access::build && !has_store)
    dataset.database = std::make_unique<Database>(fs::path());
  else
    open_store(dataset, pointer.store, request, access, disk);
  if (access != Access::inputs)
    check_owner(request, dataset.folder, dataset.recipe, known, dataset.database.get());
  if (access == Access::build) pointer = enter_folder(dataset, request, pointer, disk);
  const std::optional<DatasetRow> row = dataset.database->find_dataset(pointer.id);
  dataset.row = {pointer.id,         dataset.recipe.name, dataset.recipe.file,
                 fs::current_path(), request.overrides,   row ? row->manifest : Hash128{}};
  return dataset;
}

}  // namespace

Dataset open_dataset(const DatasetRequest& request, Access access, Disk& disk) {
  std::error_code error;
  return fs::is_directory(request.target, error) ? open_folder(request, access, disk)
                                                 : open_recipe(request, access, disk);
}

fs::path folder_of_dataset(const Store& store, const std::string& id) {
  const fs::path file = store.folder() / k_datasets / id;
  std::error_code error;
  if (fs::is_regular_file(file, error)) {
    std::string text = read_text_file(file);
    if (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }
  const fs::path above = store.folder().parent_path();
  return store.folder().filename() == k_state_folder && holds_dataset(above, id) ? above
                                                                                 : fs::path();
}

std::vector<std::pair<std::string, fs::path>> datasets_beside(const Store& store) {
  std::vector<std::pair<std::string, fs::path>> found;
  const fs::path above = store.folder().parent_path();
  if (const auto own = read_pointer(above, true); own && own->store == normal(store.folder()))
    found.emplace_back(own->id, above);
  std::error_code error;
  for (fs::directory_iterator entry(store.folder() / k_datasets, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string id = entry->path().filename().string();
    if (const fs::path folder = folder_of_dataset(store, id); holds_dataset(folder, id))
      found.emplace_back(id, folder);
  }
  return found;
}

bool holds_dataset(const fs::path& folder, const std::string& id) {
  const std::optional<Pointer> pointer = read_pointer(folder, true);
  return pointer && pointer->id == id;
}

fs::path dataset_folder(const DatasetRequest& request) {
  std::error_code error;
  if (fs::is_directory(request.target, error)) {
    check_needs_no_recipe(request);
    return normal(request.target);
  }
  const Recipe recipe = read_recipe(request.target, request.overrides);
  fs::path folder = folder_of(request, recipe);
  check_owner(request, folder, recipe, read_pointer(folder, true), nullptr);
  return folder;
}

std::optional<fs::path> recipe_left_behind(const fs::path& folder) {
  const std::optional<Pointer> pointer = read_pointer(normal(folder), true);
  if (!pointer || pointer->folder.empty()) return std::nullopt;
  const fs::path place = place_of(folder);
  if (pointer->folder == place) return std::nullopt;
  if (moved(pointer->recipe, *pointer, place) != pointer->recipe) return std::nullopt;
  return pointer->recipe;
}

bool has_lost_state(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "manifest", error) && !fs::exists(pointer_path(folder), error);
}

std::optional<fs::path> enclosing_dataset(const fs::path& path) {
  std::error_code error;
  for (fs::path folder = normal(path); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(pointer_path(folder), error)) return folder;
  return std::nullopt;
}

}  // namespace ds

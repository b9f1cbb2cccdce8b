// SPDX-License-Identifier: Apache-2.0
#include "builder/build/dataset.h"

#include "builder/build/store_database.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"

#include <random>
#include <sstream>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_state_folder = ".dsbuild";
constexpr const char* k_pointer_file = "dataset";
constexpr const char* k_pointer_header = "dsbuild dataset 1";

/// `.dsbuild/dataset`: three lines, "dsbuild dataset 1", the id, the store's folder.
struct Pointer {
  std::string id;
  fs::path store;  ///< absolute

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
  std::string header, id, store;
  std::getline(text, header);
  std::getline(text, id);
  std::getline(text, store);
  if (header != k_pointer_header || !Hash128::from_hex(id) || store.empty()) {
    if (!silent) warn(fmt::format("{}: damaged; the dataset is entered anew", file.string()));
    return std::nullopt;
  }
  return Pointer{id, normal(folder / k_state_folder / store)};
}

void write_pointer(const fs::path& folder, const Pointer& pointer, Disk& disk) {
  const fs::path state = folder / k_state_folder;
  // A store inside the dataset's folder moves with it; any other stays where it is.
  const bool own = pointer.store == state;
  const std::string text =
      fmt::format("{}\n{}\n{}\n", k_pointer_header, pointer.id, own ? "." : pointer.store.string());
  disk.write(pointer_path(folder), bytes_of(text));
}

std::string new_id() {
  std::random_device device;
  const auto word = [&] { return (std::uint64_t{device()} << 32) | device(); };
  return Hash128{word(), word()}.hex();
}

/// Relative paths in overrides start from the folder the build was started in.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
    std::error_code error;
    fs::current_path(folder, error);
    if (error)
      fail(ErrorKind::io, "{}: the folder the dataset was built from: {}", folder.string(),
           error.message());
  }
  ~WorkingFolder() {
    std::error_code ignored;
    fs::current_path(before_, ignored);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  fs::path before_;
};

void open_store(Dataset& dataset, const fs::path& folder, Disk& disk) {
  dataset.store = std::make_unique<Store>(folder, disk);
  dataset.claims = std::make_unique<Claims>(folder / "lock");
  dataset.database = open_database(*dataset.store, *dataset.claims);
}

Dataset open_folder(const DatasetRequest& request, Disk& disk) {
  if (!request.overrides.empty())
    fail(ErrorKind::usage, "--set needs a recipe, found the folder {}", request.target.string());
  if (!request.output_folder.empty())
    fail(ErrorKind::usage, "-o needs a recipe, found the folder {}", request.target.string());
  Dataset dataset;
  dataset.folder = normal(request.target);
  const std::optional<Pointer> pointer = read_pointer(dataset.folder);
  if (!pointer)
    fail(ErrorKind::usage, "{}: wanted a recipe or a folder that dsbuild built",
         request.target.string());
  std::error_code error;
  if (!fs::is_directory(pointer->store, error))
    fail(ErrorKind::io, "{}: its store {} is not there", dataset.folder.string(),
         pointer->store.string());
  open_store(dataset, pointer->store, disk);
  const std::optional<DatasetRow> row = dataset.database->find_dataset(pointer->id);
  if (!row)
    fail(ErrorKind::io, "{}: the store {} knows nothing of it; build its recipe again",
         dataset.folder.string(), pointer->store.string());
  dataset.row = *row;
  const WorkingFolder working_folder(row->working_folder);
  dataset.recipe = read_recipe(row->recipe, row->overrides);
  return dataset;
}

/// Finds or makes the dataset's row; in a build, also enters it in the folder and the database.
void enter_dataset(Dataset& dataset, std::optional<Pointer> known, Pointer pointer,
                   const DatasetRequest& request, Access access, Disk& disk) {
  std::optional<Claims::Claim> claim;
  if (access == Access::build) {
    // Builds that start at once in a new folder are to enter one dataset, not one each.
    claim.emplace(dataset.claims->own_datasets());
    if (!known) known = read_pointer(dataset.folder, true);
    if (known) pointer.id = known->id;
  }
  const std::optional<DatasetRow> row = dataset.database->find_dataset(pointer.id);
  dataset.row = {pointer.id,         dataset.recipe.name, dataset.recipe.file,
                 fs::current_path(), request.overrides,   row ? row->manifest : Hash128{}};
  if (access == Access::look) return;
  if (known != pointer) write_pointer(dataset.folder, pointer, disk);
  dataset.database->put_dataset(dataset.row);
}

Dataset open_recipe(const DatasetRequest& request, Access access, Disk& disk) {
  Dataset dataset;
  dataset.recipe = read_recipe(request.target, request.overrides);
  dataset.folder = normal(request.output_folder.empty() ? fs::path("out") / dataset.recipe.name
                                                        : request.output_folder);
  const std::optional<Pointer> known = read_pointer(dataset.folder);
  Pointer pointer = known.value_or(Pointer{new_id(), dataset.folder / k_state_folder});
  if (!request.store_folder.empty()) pointer.store = normal(request.store_folder);
  std::error_code error;
  const bool has_store = fs::is_directory(pointer.store, error);
  if (access == Access::look && !has_store)
    dataset.database = std::make_unique<Database>(fs::path());
  else
    open_store(dataset, pointer.store, disk);
  enter_dataset(dataset, known, pointer, request, access, disk);
  return dataset;
}

}  // namespace

Dataset open_dataset(const DatasetRequest& request, Access access, Disk& disk) {
  std::error_code error;
  return fs::is_directory(request.target, error) ? open_folder(request, disk)
                                                 : open_recipe(request, access, disk);
}

fs::path dataset_folder(const DatasetRequest& request) {
  std::error_code error;
  if (fs::is_directory(request.target, error)) return normal(request.target);
  if (!request.output_folder.empty()) return normal(request.output_folder);
  return normal(fs::path("out") / read_recipe(request.target, request.overrides).name);
}

std::optional<fs::path> enclosing_dataset(const fs::path& path) {
  std::error_code error;
  for (fs::path folder = normal(path); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(pointer_path(folder), error)) return folder;
  return std::nullopt;
}

}  // namespace ds

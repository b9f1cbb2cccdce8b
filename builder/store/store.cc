// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/parallel.h"
#include "tracer/base/regular_file.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <set>
#include <sys/stat.h>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

const char* folder_of(Store::Kind kind) {
  return kind == Store::Kind::object ? "objects" : "records";
}

fs::path path_in(const fs::path& store, Store::Kind kind, Hash128 hash) {
  const std::string hex = hash.hex();
  return store / folder_of(kind) / hex.substr(0, 2) / hex.substr(2);
}

/// What lies under a name.
struct Content {
  std::optional<std::string> text;  ///< the bytes, where they are what the name says
  std::string fault;                ///< else what is wrong; empty: nothing is there
  bool is_file = true;
};

/// Nothing is there also where it has just gone: others may take files away.
Content read_content(const fs::path& file, Hash128 hash) {
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  try {
    std::string text = read_text_file(file);
    if (hash_text(text) != hash) return {{}, "a file of the store is damaged"};
    return {std::move(text), ""};
  } catch (const Error&) {
    if (const auto what = what_is_no_file(file))
      return {{}, "wanted a file, found " + *what, false};
    if (!fs::exists(file, error)) return {};
    throw;
  }
}

/// Calls `visit` with all that a folder has; a folder that is not there has nothing.
template <typename Visit>
void visit_entries(const fs::path& folder, const Visit& visit) {
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error))
    visit(*entry);
  if (error && error != std::errc::no_such_file_or_directory)
    fail_system(folder, "list", error.value());
}

bool is_prefix(const std::string& name) {
  return name.size() == 2 && Hash128::from_hex(name + std::string(30, '0'));
}

fs::file_time_type file_time(const timespec& time) {
  const std::chrono::sys_time<std::chrono::nanoseconds> since_1970(
      std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
  return std::chrono::file_clock::from_sys(since_1970);
}

/// Of what stands in a folder of a prefix, or in such a folder's place; nothing of what has gone
/// meanwhile, and of folders that are not the store's.
std::optional<Store::StoredFile> stored_file(const fs::directory_entry& entry, bool in_folder) {
  const fs::path& path = entry.path();
  const std::string name = path.filename().string();
  Store::StoredFile found{.path = path, .hash = {}, .written = {}};
  if (in_folder) found.hash = Hash128::from_hex(path.parent_path().filename().string() + name);
  struct stat info {};  // one call, where the library makes one for each question
  if (::stat(path.c_str(), &info) != 0) return std::nullopt;
  if (S_ISREG(info.st_mode)) {
    found.is_temporary = process_of_temporary(name).has_value();
    found.bytes = static_cast<std::uint64_t>(info.st_size);
    found.written = file_time(info.st_mtim);
    if (!in_folder && is_prefix(name)) found.fault = "wanted a folder, found a file";
  } else if (found.hash || (!in_folder && is_prefix(name))) {
    if (const auto what = what_is_no_file(path))
      found.fault = fmt::format("wanted a {}, found {}", in_folder ? "file" : "folder", *what);
    if (found.fault.empty()) return std::nullopt;
  } else {
    return std::nullopt;
  }
  return found;
}

/// Of a folder of a prefix, or of what stands in its place.
std::vector<Store::StoredFile> files_in(const fs::directory_entry& folder) {
  std::vector<Store::StoredFile> files;
  const auto add = [&](std::optional<Store::StoredFile> file) {
    if (file) files.push_back(*std::move(file));
  };
  std::error_code vanished;
  if (!folder.is_directory(vanished))
    add(stored_file(folder, false));
  else
    visit_entries(folder.path(),
                  [&](const fs::directory_entry& entry) { add(stored_file(entry, true)); });
  return files;
}

}  // namespace

/// The local one first.
std::vector<fs::path> Store::paths_of(Kind kind, Hash128 hash) const {
  std::vector<fs::path> paths;
  if (!local_.empty()) paths.push_back(path_in(local_, kind, hash));
  paths.push_back(path_in(folder_, kind, hash));
  return paths;
}

fs::path Store::new_path(Kind kind, Hash128 hash) const {
  return paths_of(kind, hash).front();
}

fs::path Store::path_of(Kind kind, Hash128 hash) const {
  std::vector<fs::path> paths = paths_of(kind, hash);
  std::error_code error;
  for (fs::path& path : paths)
    if (fs::is_regular_file(path, error)) return std::move(path);
  return std::move(paths.back());
}

Store::Health Store::examine(Kind kind, Hash128 hash, std::string* content) const {
  Health health = Health::absent;
  for (const fs::path& file : paths_of(kind, hash)) {
    Content found = read_content(file, hash);
    if (!found.fault.empty()) health = Health::damaged;
    if (!found.text) continue;
    if (content != nullptr) *content = *std::move(found.text);
    return Health::whole;
  }
  return health;
}

std::optional<std::string> Store::read_whole(Kind kind, Hash128 hash) {
  for (const fs::path& file : paths_of(kind, hash)) {
    Content found = read_content(file, hash);
    if (found.text) return std::move(found.text);
    if (found.fault.empty()) continue;
    std::string outcome = mends_ ? ", and removed" : " (dsbuild store verify)";
    try {
      if (mends_) disk_.remove(file);
    } catch (const Error& error) {  // of somebody else, on a read-only medium, a full folder
      outcome =
          fmt::format(", and stays{}: {}", found.is_file ? "" : " (move it away)", error.what());
    }
    warn(fmt::format("{}: {}{}", file.string(), found.fault, outcome));
  }
  return std::nullopt;
}

Hash128 Store::put(std::span<const std::byte> bytes) {
  const NewObject object{hash_bytes(bytes), bytes};
  put_all({&object, 1}, {});
  return object.hash;
}

void Store::put_all(std::span<const NewObject> objects, std::span<const std::string> records) {
  std::vector<FileToWrite> files;
  std::set<Hash128> seen;
  for (const NewObject& object : objects)
    if (seen.insert(object.hash).second && !intact(object.hash))
      files.push_back({new_path(Kind::object, object.hash), object.bytes});
  const std::size_t new_objects = files.size();
  for (const std::string& text : records)
    files.push_back({new_path(Kind::record, hash_text(text)), bytes_of(text)});
  if (!files.empty()) disk_.write_all(files);
  for (std::size_t i = 0; i < new_objects; ++i)
    remove_write_permission(files[i].file);  // output files may be hard links to it
}

bool Store::has(Hash128 object) const {
  std::error_code error;
  return fs::is_regular_file(path_of(Kind::object, object), error);
}

bool Store::intact(Hash128 object) {
  return read_whole(Kind::object, object).has_value();
}

std::optional<std::vector<std::byte>> Store::get(Hash128 object) {
  const std::optional<std::string> text = read_whole(Kind::object, object);
  if (!text) return std::nullopt;
  const auto bytes = bytes_of(*text);
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

void Store::place(Hash128 object, const fs::path& target, Placing placing) {
  const ObjectToPlace one{object, target};
  place_all({&one, 1}, placing);
}

void Store::place_all(std::span<const ObjectToPlace> files, Placing placing) {
  std::vector<FileToPlace> all;
  for (const ObjectToPlace& one : files)
    all.push_back({path_of(Kind::object, one.object), one.target, placing == Placing::copy});
  if (!all.empty()) disk_.place_all(all);
}

bool Store::is_object(const fs::path& file, Hash128 object) const {
  const std::vector<fs::path> paths = paths_of(Kind::object, object);
  return std::any_of(paths.begin(), paths.end(), [&](const fs::path& path) {
    std::error_code absent;
    return fs::equivalent(file, path, absent);
  });
}

void Store::visit_files(Kind kind, const std::function<void(const StoredFile&)>& visit) const {
  for (const fs::path& store : {local_, folder_}) {
    if (store.empty()) continue;
    std::vector<fs::directory_entry> folders;
    visit_entries(store / folder_of(kind),
                  [&](const fs::directory_entry& folder) { folders.push_back(folder); });
    std::vector<std::vector<StoredFile>> found(folders.size());
    // Some at a time, so that what is found does not lie in memory all at once.
    constexpr std::size_t k_together = 16;
    for (std::size_t done = 0; done < folders.size(); done += k_together) {
      const std::size_t count = std::min(k_together, folders.size() - done);
      parallel_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = done + begin; i < done + end; ++i)
          found[i] = files_in(folders[i]);
      });
      for (std::size_t i = done; i < done + count; ++i)
        for (const StoredFile& file : std::exchange(found[i], {}))
          visit(file);
    }
  }
}

std::optional<std::string> Store::get_record(Hash128 record) {
  return read_whole(Kind::record, record);
}

void Store::remove(Kind kind, Hash128 hash) {
  for (const fs::path& file : paths_of(kind, hash))
    disk_.remove(file);
}

void Store::visit_records(const std::function<void(const std::string& text)>& visit) {
  visit_files(Kind::record, [&](const StoredFile& file) {
    if (!file.hash) return;
    if (const std::optional<std::string> text = get_record(*file.hash)) visit(*text);
  });
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/store/store.h"

#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"

#include <algorithm>
#include <set>
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

/// Nothing where there is none, also where it has just gone: others may take files away.
std::optional<std::string> read_if_there(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    return read_text_file(file);
  } catch (const Error&) {
    if (!fs::exists(file, error)) return std::nullopt;
    throw;
  }
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
    std::optional<std::string> text = read_if_there(file);
    if (!text) continue;
    health = Health::damaged;
    if (hash_text(*text) != hash) continue;
    if (content != nullptr) *content = std::move(*text);
    return Health::whole;
  }
  return health;
}

std::optional<std::string> Store::read_whole(Kind kind, Hash128 hash) {
  for (const fs::path& file : paths_of(kind, hash)) {
    std::optional<std::string> text = read_if_there(file);
    if (!text || hash_text(*text) == hash) {
      if (text) return text;
      continue;
    }
    std::string outcome = " and is made again";
    try {
      disk_.remove(file);
    } catch (const Error& error) {  // of somebody else, or on a medium that is read only
      outcome = fmt::format(", and stays: {}", error.what());
    }
    warn(fmt::format("{}: a file of the store is damaged{}", file.string(), outcome));
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
    std::error_code error;
    for (fs::recursive_directory_iterator entry(store / folder_of(kind), error), end;
         !error && entry != end; entry.increment(error)) {
      std::error_code vanished;
      if (!entry->is_regular_file(vanished)) continue;
      const fs::path& file = entry->path();
      StoredFile found{
          file,
          Hash128::from_hex(file.parent_path().filename().string() + file.filename().string()),
          entry->file_size(vanished),
          {}};
      if (!vanished) found.written = entry->last_write_time(vanished);
      if (!vanished) visit(found);
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
    if (!file.hash) return;  // a killed writer's temporary
    if (const std::optional<std::string> text = get_record(*file.hash)) visit(*text);
  });
}

}  // namespace ds

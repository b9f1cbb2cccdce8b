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

constexpr const char* k_objects = "objects";
constexpr const char* k_records = "records";

const char* folder_of(Store::Kind kind) {
  return kind == Store::Kind::object ? k_objects : k_records;
}

}  // namespace

fs::path Store::path_of(const char* kind, Hash128 hash) const {
  const std::string hex = hash.hex();
  return folder_ / kind / hex.substr(0, 2) / hex.substr(2);
}

std::optional<std::vector<std::byte>> Store::read_whole(const fs::path& file, Hash128 hash) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  const std::string text = read_text_file(file);
  if (hash_text(text) != hash) {
    warn(fmt::format("{}: a file of the store is damaged and is made again", file.string()));
    disk_.remove(file);
    return std::nullopt;
  }
  const auto bytes = bytes_of(text);
  return std::vector<std::byte>(bytes.begin(), bytes.end());
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
      files.push_back({path_of(k_objects, object.hash), object.bytes});
  const std::size_t new_objects = files.size();
  for (const std::string& text : records)
    files.push_back({path_of(k_records, hash_text(text)), bytes_of(text)});
  if (!files.empty()) disk_.write_all(files);
  for (std::size_t i = 0; i < new_objects; ++i)
    remove_write_permission(files[i].file);  // output files may be hard links to it
}

bool Store::has(Hash128 object) const {
  std::error_code error;
  return fs::is_regular_file(path_of(k_objects, object), error);
}

bool Store::intact(Hash128 object) {
  return get(object).has_value();
}

std::optional<std::vector<std::byte>> Store::get(Hash128 object) {
  return read_whole(path_of(k_objects, object), object);
}

void Store::place(Hash128 object, const fs::path& target, Placing placing) {
  const ObjectToPlace one{object, target};
  place_all({&one, 1}, placing);
}

void Store::place_all(std::span<const ObjectToPlace> files, Placing placing) {
  std::vector<FileToPlace> all;
  for (const ObjectToPlace& one : files)
    all.push_back({path_of(k_objects, one.object), one.target, placing == Placing::copy});
  if (!all.empty()) disk_.place_all(all);
}

bool Store::is_object(const fs::path& file, Hash128 object) const {
  std::error_code absent;
  return fs::equivalent(file, path_of(k_objects, object), absent);
}

void Store::visit_files(Kind kind, const std::function<void(const StoredFile&)>& visit) const {
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder_ / folder_of(kind), error), end;
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

std::optional<std::string> Store::get_record(Hash128 record) {
  const auto bytes = read_whole(path_of(k_records, record), record);
  if (!bytes) return std::nullopt;
  std::string text(bytes->size(), '\0');
  std::transform(bytes->begin(), bytes->end(), text.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  return text;
}

void Store::remove(Kind kind, Hash128 hash) {
  disk_.remove(path_of(folder_of(kind), hash));
}

void Store::visit_records(const std::function<void(const std::string& text)>& visit) {
  visit_files(Kind::record, [&](const StoredFile& file) {
    if (!file.hash) return;  // a killed writer's temporary
    if (const std::optional<std::string> text = get_record(*file.hash)) visit(*text);
  });
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/disk.h"
#include "tracer/base/hash.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// How an object comes into a dataset's folder.
enum class Placing {
  share,  ///< its blocks or its file where writing to the placed file cannot reach the store
  copy,
};

/// Content-addressed files, which any number of datasets and processes may share:
///   objects/ab/cdef...   bytes whose XXH3-128 is abcdef..., read-only
///   records/ab/cdef...   what was made from which key (see made_record.h), named by the hash of
///   the text
/// A file stands under its name only once it is whole and on the disk. What is read back is hashed
/// again: a damaged file, and what is no file, is removed, where it can be, and counts as absent, so
/// nothing wrong leaves the store.
class Store {
 public:
  /// `local`: another store's folder, on this machine's own disk, that takes what is written; what
  /// is read is looked for there first. Empty: there is none.
  Store(std::filesystem::path folder, Disk& disk, std::filesystem::path local = {})
      : folder_(std::move(folder)), local_(std::move(local)), disk_(disk) {}
  const std::filesystem::path& folder() const { return folder_; }
  const std::filesystem::path& local() const { return local_; }
  /// From now on what is damaged stays where it is; it counts as absent all the same. For who only
  /// looks.
  void leave_damage() { mends_ = false; }

  /// Throws Error(io) where the disk refuses.
  Hash128 put(std::span<const std::byte> bytes);
  /// Several objects, given by the hash of their bytes, and records, waiting for the disk as often as
  /// for one. Where it throws, any of them may be there, whole.
  struct NewObject {
    Hash128 hash;
    std::span<const std::byte> bytes;
  };
  void put_all(std::span<const NewObject> objects, std::span<const std::string> records);
  /// Whether there is such an object, without reading it.
  bool has(Hash128 object) const;
  /// Whether there is such an object, whole.
  bool intact(Hash128 object);
  std::optional<std::vector<std::byte>> get(Hash128 object);
  /// Makes `target` the object's bytes. `intact` must have been asked before.
  void place(Hash128 object, const std::filesystem::path& target, Placing placing = Placing::share);
  struct ObjectToPlace {
    Hash128 object;
    std::filesystem::path target;
  };
  void place_all(std::span<const ObjectToPlace> files, Placing placing);
  /// Whether the file is a hard link to the object.
  bool is_object(const std::filesystem::path& file, Hash128 object) const;

  void put_record(const std::string& text) { put_all({}, {&text, 1}); }
  /// Calls `visit` with the text of every whole record, in no particular order.
  void visit_records(const std::function<void(const std::string& text)>& visit);

  /// A file of the store as it lies there, read or not.
  struct StoredFile {
    std::filesystem::path path;
    std::optional<Hash128> hash;  ///< that its name stands for; nothing: no file of ours
    std::uint64_t bytes = 0;
    std::filesystem::file_time_type written;
    bool is_temporary = false;  ///< half-written, maybe by who was killed
    std::string fault{};        ///< what stands there in its place: "wanted a file, found a folder"
  };
  enum class Kind { object, record };
  /// In no particular order. Throws Error(io) where a folder of the store cannot be listed: what is not seen
  /// is not to be taken for absent.
  void visit_files(Kind kind, const std::function<void(const StoredFile&)>& visit) const;
  enum class Health { absent, whole, damaged };
  /// Reads the file, or else the one of the same name that is not local, and leaves all as it is.
  /// `content` is filled where it is whole. What is no file is damaged. Throws Error(io) where a file
  /// is there and cannot be read.
  Health examine(Kind kind, Hash128 hash, std::string* content = nullptr) const;
  /// The text of a record, where it is whole.
  std::optional<std::string> get_record(Hash128 record);
  /// No error where there is no such file.
  void remove(Kind kind, Hash128 hash);

 private:
  /// Where it is to be written; where it lies, or would.
  std::filesystem::path new_path(Kind kind, Hash128 hash) const;
  std::filesystem::path path_of(Kind kind, Hash128 hash) const;
  std::vector<std::filesystem::path> paths_of(Kind kind, Hash128 hash) const;
  std::optional<std::string> read_whole(Kind kind, Hash128 hash);

  std::filesystem::path folder_, local_;
  Disk& disk_;
  bool mends_ = true;
};

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"
#include "manifests/whole_folder.h"
#include "tracer/base/file_batch.h"
#include "tracer/base/file_writer.h"
#include "tracer/base/hash_stream.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// The bytes of a dataset's file. Throws Error(asset) where they are not those that the manifest has.
std::string read_checked(const std::filesystem::path& folder, const FileRecord& file);

/// The folder that an export makes: all of it or nothing (WholeFolder). Paths are relative to the
/// folder.
class ExportFolder {
 public:
  /// `from`: the dataset's folder. Throws Error(usage) where `to` is there and no export; with
  /// `copy` no file is shared with the dataset.
  ExportFolder(std::filesystem::path from, const std::filesystem::path& to, bool copy);
  ~ExportFolder();
  ExportFolder(const ExportFolder&) = delete;
  ExportFolder& operator=(const ExportFolder&) = delete;

  /// A file of the dataset, by reflink or hard link where that can be, after its bytes were compared
  /// with the manifest's.
  void place(const FileRecord& file, const std::string& path);
  void write(const std::string& path, std::string_view text);

  /// A file that is written piece by piece.
  class Stream {
   public:
    Stream(ExportFolder& folder, std::string path);
    void write(std::string_view text);
    /// Must be called: without it the file is not there.
    void close();
    std::uint64_t bytes() const { return bytes_; }

   private:
    ExportFolder& folder_;
    std::string path_;
    FileWriter writer_;
    HashStream hash_;
    std::uint64_t bytes_ = 0;
  };

  /// Something that readers of the export must know; each text once, as a warning and in
  /// export.json.
  void note(const std::string& text);
  const std::vector<std::string>& notes() const { return notes_; }
  std::uint64_t files() const { return whole_.files(); }
  std::uint64_t bytes() const { return bytes_; }

  /// `record`: of export.json. Replaces an export that stands there.
  void commit(const std::string& record);

 private:
  void enter(const std::string& path, Hash128 hash, std::uint64_t bytes);
  void flush();

  std::filesystem::path from_;
  WholeFolder whole_;  ///< before `batch_`, which writes into it
  bool copy_;
  std::uint64_t bytes_ = 0;
  std::vector<std::string> notes_;
  std::unique_ptr<FileBatch> batch_;
  std::size_t in_batch_ = 0;
};

}  // namespace ds

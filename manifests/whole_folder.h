// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/hash.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>

namespace ds {

/// A sort of folder that dsbuild makes as a whole.
struct WholeFolderKind {
  const char* name;       ///< "export": what messages call it
  const char* work;       ///< folder beside it in which it is written
  const char* record;     ///< file in it that tells it from other folders
  const char* checksums;  ///< file in it: checksums of all others, as in a dataset's manifest
};

/// Of `dsbuild export`, `dsbuild gallery` and `dsbuild diff -o`.
inline constexpr WholeFolderKind k_export_folder{
    "export", ".dsbuild-export", ".dsbuild-export/export.json", ".dsbuild-export/checksums.xxh128"};
inline constexpr WholeFolderKind k_gallery_folder{"gallery", ".dsbuild-gallery",
                                                  ".dsbuild-gallery/made.txt",
                                                  ".dsbuild-gallery/checksums.xxh128"};
inline constexpr WholeFolderKind k_diff_folder{"diff", ".dsbuild-diff", ".dsbuild-diff/diff.json",
                                               ".dsbuild-diff/checksums.xxh128"};

/// Whether such a folder stands there.
bool is_whole_folder(const std::filesystem::path& folder, const WholeFolderKind& kind);
/// Which sort stands there; null where none does.
const WholeFolderKind* whole_folder_kind(const std::filesystem::path& folder);

/// The folder as it is under all links. Throws Error(usage) where something stands there that may not be
/// replaced: no such folder, or one that holds what none of these put there.
std::filesystem::path checked_place(const std::filesystem::path& to, const WholeFolderKind& kind);

/// Removes what processes that were killed while they made one for that place left beside it; WholeFolder
/// does so too. `place` as checked_place returns it.
void remove_leftovers(const std::filesystem::path& place, const WholeFolderKind& kind);

/// As it is under all links, where that can be told.
std::filesystem::path real_place(const std::filesystem::path& path);
/// Throws Error(usage) where `to` lies in what builds, exports and verify take for theirs of a dataset's
/// folder.
void check_outside(const std::filesystem::path& to, const std::filesystem::path& dataset);

/// A folder that is there whole or not at all. It is written beside its place, and takes it in `commit`;
/// of a process that was killed the next one for that parent removes what it left. Paths are relative
/// to the folder. All functions throw Error(io).
class WholeFolder {
 public:
  /// `to` as checked_place takes it.
  WholeFolder(const std::filesystem::path& to, const WholeFolderKind& kind);
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;

  /// Where its files are to be written.
  const std::filesystem::path& folder() const { return folder_; }
  /// Where it will stand, and one that it replaces stands; of a link what that leads to.
  const std::filesystem::path& place() const { return to_; }
  bool replaces() const { return replaces_; }

  /// A file that is written, or will be before `commit`. Error(asset) for a second one of that path.
  void enter(const std::string& path, Hash128 hash);
  /// Writes one, and enters it. It waits for no disk: a power cut may tear it, which its checksum
  /// tells. For what can be made again.
  void write(const std::string& path, std::span<const std::byte> bytes);
  /// One of the folder that stands there, whose bytes have that hash, under another name or the same.
  void keep(const std::string& path, Hash128 hash, const std::string& before);
  std::size_t files() const { return checksums_.size(); }
  /// Writes the checksums; replaces the folder that stands there.
  void commit();

 private:
  std::filesystem::path new_file(const std::string& path);

  /// Removed with all that is in it, also where making the rest fails.
  struct WorkFolder {
    std::filesystem::path path;
    ~WorkFolder();
  };

  WholeFolderKind kind_;
  std::filesystem::path to_;
  bool replaces_ = false;
  WorkFolder work_;
  std::filesystem::path folder_;
  std::map<std::string, Hash128> checksums_;
  std::set<std::filesystem::path> folders_;  ///< that have been made
};

}  // namespace ds

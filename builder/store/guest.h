// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/store/store.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// What a guest that builds makes in the store as it comes and as it goes: the store's own database, if there
/// is one, is to read the records that are new (open_database).
inline constexpr const char* k_filled_file = "filled";

/// Who works in a store without a lock of its own there, since its database and locks are elsewhere
/// (--database), and who collects it, tell each other by a file each in the store's `guests`:
///   HOST.PROCESS   its text is "gc" or "build", and what is built
/// Each writes its own file before it looks for the others', so that of two that come at once at least
/// one sees the other. Files of processes of this machine that have gone are taken away by who comes
/// next; what was killed on another machine leaves one that somebody has to remove, since nobody can
/// tell.
class Guest {
 public:
  /// Builds into the store: waits for a collection, which `waits_for` is told once. Throws Error(io).
  static Guest build(const Store& store, const std::string& what,
                     const std::function<void(const std::string& who)>& waits_for);
  /// Collects the store. Throws Error(usage) where others build into it, and names them.
  static Guest collect(const Store& store);
  /// Throws as `collect` would now, and leaves all as it is.
  static void check_collect(const Store& store);
  /// A guest that builds now, or did when it was killed on another machine.
  struct Builder {
    std::string who, what;                  ///< "process 17 on host", "build /home/me/recipe.toml"
    std::filesystem::file_time_type since;  ///< when it came
  };
  /// Leaves all as it is.
  static std::vector<Builder> builders(const Store& store);
  ~Guest();
  Guest(Guest&& other) noexcept;
  Guest& operator=(Guest&&) = delete;

 private:
  Guest(const Store& store, const std::string& text);
  void note_filled() const;

  std::filesystem::path file_;
  bool builds_ = false;
};

}  // namespace ds

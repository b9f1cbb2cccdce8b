// SPDX-License-Identifier: Apache-2.0
#include "builder/build/folder_lock.h"

#include "builder/build/host.h"
#include "builder/build/manifest_state.h"

#include <array>
#include <chrono>
#include <limits>
#include <thread>
#include <unistd.h>

namespace ds {
namespace {

constexpr long k_gate = 0;
constexpr long k_end = std::numeric_limits<long>::max();
/// How often a build that waits looks whether it may go on.
constexpr std::chrono::milliseconds k_poll{100};

std::string read_who(int descriptor) {
  std::array<char, 4096> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  std::string who(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  return who.empty() ? "another process" : who;
}

/// For people only: what is lost of it on a full disk is no reason to fail.
void write_who(int descriptor, const std::string& who) {
  if (::ftruncate(descriptor, 0) != 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, who.data(), who.size(), 0);
}

std::string who_builds(const Dataset& dataset) {
  std::string text =
      fmt::format("process {} on {}, {}", ::getpid(), host_name(), dataset.recipe.file.string());
  for (const std::string& assignment : dataset.row.overrides)
    text += " --set " + assignment;
  return text;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : file_(folder / ".dsbuild" / "build") {}

FolderLock::Gate::Gate(FolderLock& lock) : lock_(lock) {
  lock_.file_.take(LockFile::Lock::exclusive, k_gate);
}

FolderLock::Gate::~Gate() {
  lock_.file_.release(k_gate);
}

std::optional<std::string> FolderLock::try_join(Hash128 what, const std::string& who) {
  const Gate gate(*this);
  const long own = LockFile::offset_of(what);
  if (file_.others_hold(k_gate + 1, own) || file_.others_hold(own + 1, k_end))
    return read_who(file_.descriptor());
  file_.take(LockFile::Lock::shared, own);
  held_ = own;
  write_who(file_.descriptor(), who);
  return std::nullopt;
}

void FolderLock::leave() {
  if (held_) file_.release(*held_);
  held_.reset();
}

SolePlan make_sole_plan(Dataset& dataset, Stamps stamps, bool force, Shard shard,
                        const std::function<void(const std::string& who)>& waits_for) {
  SolePlan sole;
  sole.lock = std::make_unique<FolderLock>(dataset.folder);
  const auto plan = [&] {
    sole.inputs = std::make_unique<Inputs>(*dataset.database, stamps);
    sole.plan = make_plan(dataset, *sole.inputs, force, shard);
    return what_is_made(sole.plan);
  };
  std::string told;
  for (;;) {
    const std::int64_t version = dataset.database->data_version();
    const Hash128 what = plan();
    bool waited = false;
    while (const auto other = sole.lock->try_join(what, who_builds(dataset))) {
      if (*other != told) waits_for(*other);
      told = *other;
      waited = true;
      std::this_thread::sleep_for(k_poll);
    }
    // What others did since this was planned is not in the plan; from now on only those who make
    // the same do anything.
    if (!waited && version == dataset.database->data_version()) return sole;
    if (plan() == what) return sole;
    sole.lock->leave();  // a file was edited meanwhile
  }
}

}  // namespace ds

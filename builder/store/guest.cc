// SPDX-License-Identifier: Apache-2.0
#include "builder/store/guest.h"

#include "builder/store/host.h"
#include "builder/store/killed_builds.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"

#include <charconv>
#include <chrono>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_collects = "gc";
/// How often a build looks whether the collection has ended.
constexpr std::chrono::milliseconds k_poll{100};

std::string own_host() {
  const std::string host = host_name();
  return host.empty() ? "unknown" : host;
}

struct Name {
  std::string host;
  std::int64_t process = 0;
};

std::optional<Name> name_of(const fs::path& file) {
  const std::string text = file.filename().string();
  const std::size_t dot = text.rfind('.');
  if (dot == 0 || dot == text.npos) return std::nullopt;
  Name name{text.substr(0, dot), 0};
  const auto [end, error] =
      std::from_chars(text.data() + dot + 1, text.data() + text.size(), name.process);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return name;
}

/// Nothing where it has just gone.
std::optional<std::string> text_of(const fs::path& file) {
  try {
    return read_text_file(file);
  } catch (const Error&) {
    std::error_code error;
    if (!fs::exists(file, error)) return std::nullopt;
    throw;
  }
}

struct Other {
  fs::path file;
  std::string text;
  std::string who;  ///< "process 17 on host"
};

enum class Gone { remove, leave };

/// Guests but `own`, which may be empty. Files of those that are gone: as `gone` says.
std::vector<Other> find_others(const fs::path& guests, const fs::path& own, bool that_collect,
                               Gone gone) {
  std::error_code error;
  std::vector<Other> found;
  for (fs::directory_iterator entry(guests, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::optional<Name> name = name_of(entry->path());
    if (!name || entry->path() == own) continue;
    if (name->host == own_host() && !is_running(name->process)) {
      if (gone == Gone::remove) ::unlink(entry->path().c_str());
      continue;
    }
    const std::optional<std::string> text = text_of(entry->path());
    if (text && (*text == k_collects) == that_collect)
      found.push_back(
          {entry->path(), *text, fmt::format("process {} on {}", name->process, name->host)});
  }
  if (error && error != std::errc::no_such_file_or_directory)
    fail_system(guests, "list", error.value());
  return found;
}

std::optional<Other> find_other(const fs::path& guests, const fs::path& own, bool that_collects,
                                Gone gone) {
  const std::vector<Other> all = find_others(guests, own, that_collects, gone);
  return all.empty() ? std::nullopt : std::optional(all.back());
}

void refuse_beside(const Store& store, const std::optional<Other>& other) {
  if (!other) return;
  fail(ErrorKind::usage,
       "{}: {} works in it with a database of its own ({}), so what it names is not known here; "
       "collect when that has ended, or remove {} if it has",
       store.folder().string(), other->who, other->text, other->file.string());
}

fs::path guests_of(const Store& store) {
  return store.folder() / "guests";
}

}  // namespace

Guest::Guest(const Store& store, const std::string& text)
    : file_(guests_of(store) / fmt::format("{}.{}", own_host(), ::getpid())) {
  write_file_atomic(file_, text);
}

Guest::Guest(Guest&& other) noexcept
    : file_(std::exchange(other.file_, {})), builds_(other.builds_) {}

Guest::~Guest() {
  if (file_.empty()) return;
  if (builds_) try {
      note_filled();
    } catch (const Error& error) {
      warn(fmt::format("what was made may be made again: {}", error.what()));
    }
  ::unlink(file_.c_str());
}

void Guest::note_filled() const {
  write_file_atomic(file_.parent_path().parent_path() / k_filled_file, "");
}

Guest Guest::build(const Store& store, const std::string& what,
                   const std::function<void(const std::string& who)>& waits_for) {
  Guest guest(store, "build " + what);
  guest.builds_ = true;
  guest.note_filled();
  for (bool told = false;; told = true) {
    const auto other = find_other(guests_of(store), guest.file_, true, Gone::remove);
    if (!other) return guest;
    if (!told)
      waits_for(fmt::format("{} (remove {} if it has ended)", other->who, other->file.string()));
    std::this_thread::sleep_for(k_poll);
  }
}

Guest Guest::collect(const Store& store) {
  Guest guest(store, k_collects);
  refuse_beside(store, find_other(guests_of(store), guest.file_, false, Gone::remove));
  return guest;
}

void Guest::check_collect(const Store& store) {
  refuse_beside(store, find_other(guests_of(store), {}, false, Gone::leave));
}

std::vector<Guest::Builder> Guest::builders(const Store& store) {
  std::vector<Builder> found;
  for (const Other& other : find_others(guests_of(store), {}, false, Gone::leave)) {
    std::error_code gone;
    const auto since = fs::last_write_time(other.file, gone);
    if (!gone) found.push_back({other.who, other.text, since});
  }
  return found;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/db/file_check.h"

#include "tracer/base/error.h"
#include "tracer/base/regular_file.h"

#include <exception>
#include <fstream>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::optional<FileStamp> read_mark(const fs::path& file) {
  FileStamp stamp;
  std::ifstream in = regular_stream(file);
  if (in >> stamp.size_bytes >> stamp.mtime_ns >> stamp.ctime_ns >> stamp.inode) return stamp;
  return std::nullopt;
}

}  // namespace

FileCheck::FileCheck(fs::path file)
    : file_(std::move(file)), exceptions_(std::uncaught_exceptions()) {
  if (file_.empty()) return;
  stamp_ = read_mark(mark());
  needed_ = !stamp_ || !log_is_empty() || stamp_of(file_) != stamp_;
}

void FileCheck::passed() {
  if (file_.empty()) return;
  std::error_code error;
  try {
    const std::optional<FileStamp> stamp = stamp_of(file_);
    if (std::uncaught_exceptions() > exceptions_ || !stamp || !log_is_empty()) {
      fs::remove(mark(), error);
    } else if (stamp != stamp_) {
      // No sync and no rename: what is torn is no mark.
      std::ofstream out(mark());
      out << stamp->size_bytes << ' ' << stamp->mtime_ns << ' ' << stamp->ctime_ns << ' '
          << stamp->inode << '\n';
    }
  } catch (const Error&) {
    fs::remove(mark(), error);
  }
}

fs::path FileCheck::mark() const {
  return file_.string() + "-checked";
}

bool FileCheck::log_is_empty() const {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file_.string() + "-wal", error);
  return error || size == 0;
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/build/claims.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

constexpr long k_database_offset = 0;
constexpr std::uint64_t k_offset_mask = (std::uint64_t{1} << 62) - 1;
constexpr long k_datasets_offset = (1L << 62) + 1;  // above those of all images

long offset_of(Hash128 key) {
  return static_cast<long>((key.low & k_offset_mask) + 1);
}

}  // namespace

Claims::Claims(const std::filesystem::path& file) : file_(file) {
  make_folders(file.parent_path());
  fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0)
    fail(ErrorKind::io, "{}: cannot open: {}", file.string(),
         std::generic_category().message(errno));
}

Claims::~Claims() {
  ::close(fd_);
}

Claims::Claim::~Claim() {
  if (claims_ != nullptr) claims_->set(F_UNLCK, offset_, false);
}

bool Claims::set(short type, long offset, bool wait) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = offset;
  lock.l_len = 1;
  // Locks of the open file, not of the process: those of the process vanish when any descriptor of
  // the file closes.
  while (::fcntl(fd_, wait ? F_OFD_SETLKW : F_OFD_SETLK, &lock) != 0) {
    if (errno == EINTR) continue;
    if (!wait && (errno == EAGAIN || errno == EACCES)) return false;
    fail(ErrorKind::io, "{}: cannot lock: {}", file_.string(),
         std::generic_category().message(errno));
  }
  return true;
}

std::optional<Claims::Claim> Claims::try_image(Hash128 key) {
  const long offset = offset_of(key);
  if (!set(F_WRLCK, offset, false)) return std::nullopt;
  return std::make_optional<Claim>(*this, offset);
}

Claims::Claim Claims::own_datasets() {
  set(F_WRLCK, k_datasets_offset, true);
  return {*this, k_datasets_offset};
}

void Claims::share_database() {
  set(F_RDLCK, k_database_offset, true);
}

bool Claims::try_own_database() {
  return set(F_WRLCK, k_database_offset, false);
}

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#include "builder/store/claims.h"

namespace ds {
namespace {

constexpr long k_database_offset = 0;
constexpr long k_datasets_offset = (1L << 62) + 1;  // above those of all images

}  // namespace

Claims::Claim::~Claim() {
  if (claims_ != nullptr) claims_->file_.release(offset_);
}

std::optional<Claims::Claim> Claims::try_image(Hash128 key) {
  const long offset = LockFile::offset_of(key);
  if (!file_.try_take(LockFile::Lock::exclusive, offset)) return std::nullopt;
  return std::make_optional<Claim>(*this, offset);
}

Claims::Claim Claims::own_datasets() {
  file_.take(LockFile::Lock::exclusive, k_datasets_offset);
  return {*this, k_datasets_offset};
}

void Claims::share_database() {
  file_.take(LockFile::Lock::shared, k_database_offset);
}

bool Claims::try_own_database() {
  return file_.try_take(LockFile::Lock::exclusive, k_database_offset);
}

}  // namespace ds

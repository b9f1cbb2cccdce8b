// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/sqlite.h"
#include "tracer/base/hash.h"

namespace ds {

/// A column of 32 hexadecimal digits. Throws DamagedDatabase where it is none.
inline Hash128 hash_column(const Statement& row, int column) {
  const std::optional<Hash128> hash = Hash128::from_hex(row.view(column));
  if (!hash)
    throw DamagedDatabase(
        fmt::format("the database is damaged: \"{}\" is no hash", row.text(column)));
  return *hash;
}

}  // namespace ds

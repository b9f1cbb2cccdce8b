// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/sqlite.h"

namespace ds {

/// Version of the tables, in the file's `user_version`.
///   1: first
///   2: product.facts; '' in rows of version 1, whose films' facts were not kept
///   3: geometry.damage; rows of older versions are dropped, and their models read once more
///   4: ctime_ns in input_file and placed; 0, which no file has, in rows of older versions, so that
///      their files are read once more
///   5: sphere
///   6: product_rejected
///   7: product_capped
///   8: geometry.uvs, colors and box, and image_bounds; rows of geometry of older versions are
///      dropped, and their models read once more
///   9: known
///   10: geometry.normals; rows of older versions are dropped likewise
/// An older file is converted when it is opened; a newer one is refused, since writing to it could
/// lose what this program does not know.
inline constexpr int k_schema_version = 12;

/// Makes the tables where the file is new. Throws Error(io) for a file of a newer version,
/// DamagedDatabase for one that is some other program's.
void prepare_schema(Connection& connection, const std::string& name);

}  // namespace ds

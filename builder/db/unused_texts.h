// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"

#include <set>
#include <string>
#include <vector>

namespace ds {

/// Hashes of canonical texts that no image needs any more: none of its parts is one, and none of those
/// refers to it ("@" and its hash). Images of the datasets in `without` count for nothing.
std::vector<Hash128> unused_texts(Database& database, const std::set<std::string>& without);
void remove_text(Database& database, Hash128 hash);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/pictures.h"

#include <map>
#include <string>
#include <vector>

namespace ds::pictures {

/// Which pictures to make, and how. Sizes of 0: as the pictures say; with `spp` the picture by an
/// error target has that many samples as well.
struct BitsRequest {
  TracerOptions tracer = tracer_options();
  int width = 0, height = 0, spp = 0;
  std::vector<std::string> names;  ///< empty: all of all_effects(), and "scheduled"
};

/// "host_version", "geometry program" and, for each picture, "NAME program" (of the specialised
/// program's text without comments), "NAME film" and "NAME geometry" (mask and depth); hashes as 32
/// hexadecimal digits.
/// Throws Error(usage) for a name that no picture has.
std::map<std::string, std::string> bits_of(const BitsRequest& request);

/// A table as golden_bits.txt has it: a "KEY VALUE" a line, sorted by key.
std::string to_text(const std::map<std::string, std::string>& table);

}  // namespace ds::pictures

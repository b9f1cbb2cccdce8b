// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/render/pictures.h"

#include <functional>
#include <string>
#include <vector>

/// A hard case holds in strict and in fast arithmetic, one path a work-item and eight, in the
/// program made for the scene and in the one of all effects.
namespace ds::hard {

struct Way {
  MathMode math = MathMode::strict;
  int lanes = 8;
  bool full_program = false;
  std::string name() const;
};

/// All eight.
std::vector<Way> ways();

/// Traces on a tracer that the process keeps for each way.
Film trace(const pictures::Picture& picture, const Way& way);

/// Traces the picture in every way and asks `check` of each film. Strict films must be equal to the
/// last bit; no film may hold what is not finite or negative, and no sample may be rejected.
void everywhere(const pictures::Picture& picture, const std::function<void(const Film&)>& check);

/// Mean over all pixels and channels of independent pictures, and its standard error.
pictures::Estimate estimate(const pictures::Picture& picture, const Way& way, int pictures,
                            std::uint64_t first_seed = 1);

/// Every material of the table but mix and, where asked, those that let light through.
std::vector<std::string> materials(bool with_transparent);

/// A small square picture that follows paths to any depth and plays no roulette before `roulette`.
pictures::Picture deep_picture(int pixels, int spp, int roulette = 1000);

/// Largest difference of any value from `expected`.
double worst_difference(const Film& film, double expected);
double mean_of(const Film& film);

}  // namespace ds::hard

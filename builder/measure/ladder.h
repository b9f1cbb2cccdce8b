// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/accuracy.h"

namespace ds {

/// 1, 2, 4, ... and `most_spp` itself.
std::vector<int> ladder_of(int most_spp);

/// The seed of the report's picture `number`: nothing in common with the recipe's own seeds.
std::uint64_t report_seed(std::uint64_t recipe_seed, int number);

/// Traces the reference and every rung and fills what of the pair follows from them:
/// `setup_seconds`, `ladder`, `plain_sums`, `reference_error`, `floor`. Sets the tracer's scene.
void measure_ladder(PairAccuracy& pair, SceneTracer& tracer, const Subject& subject,
                    const ToneMap& tone_map, const AccuracyOptions& options,
                    const std::atomic<bool>& stop);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/accuracy.h"

namespace ds {

/// Traces the subject as it is and with each of its choices, with the same seeds: their noise is
/// then largely the same, and so much smaller differences are seen. Sets the tracer's scene.
///
/// What `bias` is measured against: for path depth, the deepest path; for all else, the subject.
std::vector<ChoiceCost> measure_choices(SceneTracer& tracer, const Subject& subject,
                                        const AccuracyOptions& options,
                                        const std::atomic<bool>& stop);

}  // namespace ds

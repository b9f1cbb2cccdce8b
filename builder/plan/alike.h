// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"
#include "tracer/scene/scene.h"

namespace ds {

bool same(const Camera& a, const Camera& b);
bool same_but_seed(const EngineSettings& a, const EngineSettings& b);

}  // namespace ds

// SPDX-License-Identifier: Apache-2.0
// The data layout of types.h as C++, in namespace ds::kernels.
#pragma once

#include "tracer/kernels/host.h"

namespace ds::DS_KERNELS {
#include "tracer/kernels/types.h"
}  // namespace ds::DS_KERNELS

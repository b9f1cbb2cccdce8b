// SPDX-License-Identifier: Apache-2.0
// One of two materials at random, the second with probability `amount`: a pure choice, made by
// resolve_mix of shade.h before any BSDF is asked, so a path pays for one of them only.
#pragma once

#include "tracer/kernels/bsdf.h"

#define DS_MIX_INPUTS(INPUT) INPUT(mix_amount, 1, 0.5f)
#define DS_MIX_NUMBERS(NUMBER)
enum { DS_MIX_INPUTS(DS_SLOT) mix_end, mix_derived = 0 };

DS_FN void mix_prepare(const real* p, Viewer viewer, real* derived) {}

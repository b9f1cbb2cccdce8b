// SPDX-License-Identifier: Apache-2.0
// The kernels as devices run them.
#define DS_LENS
#define DS_AUDIT in_float
#include "tests/precision/answers.h"
